//! How inputs and outputs are called in the code.
//!
//! The rule: lower-case letters, digits and `_` in place of everything else, a letter first; a word that a language keeps
//! for itself gets `_value` behind it, and a name that is taken already `_2`, `_3`, ….

use fspid_fuzzy::system::Parts;

use crate::export::identifier;

/// Names of members, in the order of the system's variables.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Names {
    /// Of the sample's members.
    pub inputs: Vec<String>,
    /// Of the answer's values.
    pub outputs: Vec<String>,
    /// Of the answer's sources.
    pub sources: Vec<String>,
    /// Of the member that says what is wrong with the inputs.
    pub faults: String,
}

/// Words that one of the languages keeps for itself (C11, C++, Lua 5.3, IEC 61131-3, MATLAB, Rust, Python), or that the
/// code uses for its parts.
const KEPT: &str = "and array asm at auto begin bool break by byte case catch char class configuration const continue \
    date default delete design do double dt elif else elseif elsif end enum except exit explicit export extern false fault \
    faults finally float fn for friend from function global goto if impl import in inline int is lambda let local long loop \
    match mod mut namespace new nil nonlocal not null of on operator or otherwise parfor pass persistent pi private program \
    protected pub public raise ref register repeat restrict retain return sample self short signed sizeof spmd state \
    static string struct super switch task template then this throw time to tod trait true try type typedef typename union \
    unsafe unsigned until use using var virtual void volatile wchar when where while with word xor yield answer infer int8 \
    alignas alignof and_eq bitand bitor char16_t char32_t char8_t co_await co_return co_yield compl concept const_cast \
    consteval constexpr constinit decltype dynamic_cast mutable noexcept not_eq nullptr or_eq reinterpret_cast \
    requires static_assert static_cast thread_local typeid typeof typeof_unqual wchar_t xor_eq linux unix \
    real reset lreal sint usint uint dint udint lint ulint dword lword any";

/// A name that is none of `taken`, by the rule; `taken` has it then.
pub(super) fn unique(name: &str, taken: &mut Vec<String>) -> String {
    let wanted = identifier_of(name);
    let numbered = (2..).map(|number| format!("{wanted}_{number}"));
    let mut all = std::iter::once(wanted.clone()).chain(numbered);
    let free = all.find(|name| !taken.contains(name)).unwrap_or(wanted);
    taken.push(free.clone());
    free
}

fn identifier_of(name: &str) -> String {
    let plain = identifier(name);
    // `identifier` speaks of controllers where a name has no letter to begin with.
    let plain = match plain.strip_prefix("controller") {
        Some(rest) if !name.to_ascii_lowercase().starts_with("controller") => {
            format!("value{rest}")
        }
        _ => plain,
    };
    if KEPT.split_whitespace().any(|word| word == plain) { plain + "_value" } else { plain }
}

impl Names {
    /// The names of a system's variables.
    pub(super) fn of(parts: &Parts) -> Self {
        let mut taken = Vec::new();
        let inputs = parts.inputs.iter().map(|it| unique(&it.name, &mut taken)).collect();
        taken.push("faults".to_owned());
        let outputs: Vec<String> =
            parts.outputs.iter().map(|it| unique(&it.name, &mut taken)).collect();
        let sources =
            outputs.iter().map(|name| unique(&format!("{name}_source"), &mut taken)).collect();
        Self { inputs, outputs, sources, faults: "faults".to_owned() }
    }

    /// Which variables have another name in the code: as in the file, and there.
    pub(super) fn changed<'a>(&'a self, parts: &'a Parts) -> impl Iterator<Item = [&'a str; 2]> {
        let inputs = parts.inputs.iter().map(|it| &it.name).zip(&self.inputs);
        let outputs = parts.outputs.iter().map(|it| &it.name).zip(&self.outputs);
        let all = inputs.chain(outputs).map(|(name, called)| [name.as_str(), called.as_str()]);
        all.filter(|[name, called]| name != called)
    }
}

#[cfg(test)]
mod tests {
    use super::identifier_of;

    /// The C compiled, and was none of C++ and of C23 with these names.
    #[test]
    fn words_of_cpp_and_of_c23_get_value_behind_them() {
        for word in [
            "mutable",
            "compl",
            "bitand",
            "not_eq",
            "nullptr",
            "constexpr",
            "wchar_t",
            "typeof",
            "linux",
        ] {
            assert_eq!(identifier_of(word), format!("{word}_value"));
        }
        assert_eq!(identifier_of("room"), "room");
    }
}
