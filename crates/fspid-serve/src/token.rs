//! What only the person knows who started the server.

use std::fmt;
use std::hint::black_box;

/// 128 random bits of the system, as 32 hexadecimal digits.
#[derive(Clone)]
pub(crate) struct Token(String);

impl Token {
    /// A new one.
    pub(crate) fn random() -> Result<Self, getrandom::Error> {
        let mut bytes = [0; 16];
        getrandom::fill(&mut bytes)?;
        Ok(Self(bytes.iter().map(|byte| format!("{byte:02x}")).collect()))
    }

    /// One that is known: of a server that nobody can connect to.
    pub(crate) fn of(text: &str) -> Self {
        Self(text.to_owned())
    }

    /// True for the token itself. How long it takes says nothing of where the two differ.
    pub(crate) fn is(&self, found: &[u8]) -> bool {
        let own = self.0.as_bytes();
        let pairs = own.iter().zip(found.iter().chain(std::iter::repeat(&0)));
        let differing = pairs.fold(0, |all, (a, b)| black_box(all | (a ^ b)));
        differing == 0 && own.len() == found.len()
    }

    /// As text, for the fragment of an address.
    pub(crate) fn text(&self) -> &str {
        &self.0
    }
}

impl fmt::Debug for Token {
    /// Not what it is: what is printed for a programmer ends in logs.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Token(..)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_itself_and_nothing_that_is_shorter_longer_or_another() {
        let token = Token::random().expect("the system has random bits");
        let text = token.text().to_owned();
        assert!(text.len() == 32 && text.chars().all(|c| c.is_ascii_hexdigit()));
        assert!(token.is(text.as_bytes()));
        let another = Token::random().expect("the system has random bits");
        let longer = format!("{text}\0");
        for wrong in ["", "0", &text[..31], &longer, &text.to_uppercase(), another.text()] {
            assert!(!token.is(wrong.as_bytes()) || wrong == text, "{wrong:?}");
        }
        assert!(!format!("{token:?}").contains(&text));
    }
}
