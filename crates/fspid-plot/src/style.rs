//! How things are drawn: roles with their colours, dash patterns and markers.
//!
//! Nothing in a figure has a free colour. A thing has a [`Role`]; the role has a fallback colour for
//! stand-alone files and a CSS variable that a page can set, for instance for its dark mode.

/// How a line is drawn, by what it stands for.
///
/// The numbered styles pair a colour of the Okabe-Ito palette with a dash pattern and a marker of its
/// own, so they stay apart in greyscale print and for colour-blind readers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum SeriesStyle {
    /// The commanded value: a thin neutral grey line.
    Setpoint,
    /// A second commanded or limiting value: as `Setpoint`, but dashed.
    SetpointDashed,
    /// The n-th measured thing, from 0; repeats after [`SeriesStyle::COUNT`].
    Numbered(usize),
}

/// Dash patterns of the numbered styles; the first is a full line.
const DASHES: [&str; SeriesStyle::COUNT] =
    ["", "7 3", "2.2 2.4", "9 3 2 3", "13 4", "4 2.2", "9 2.5 2 2.5 2 2.5"];

impl SeriesStyle {
    /// Number of distinct numbered styles.
    pub const COUNT: usize = 7;

    /// Tells styles apart where a script asks which curve a legend means.
    pub(super) fn key(self) -> String {
        match self {
            Self::Setpoint => "set-point".to_owned(),
            Self::SetpointDashed => "set-point-dashed".to_owned(),
            Self::Numbered(n) => n.to_string(),
        }
    }

    /// The role that colours the line.
    pub(super) fn role(self) -> Role {
        match self {
            Self::Setpoint | Self::SetpointDashed => Role::Setpoint,
            Self::Numbered(n) => Role::Series(n % Self::COUNT),
        }
    }

    /// The SVG dash pattern; empty for a full line.
    pub(super) fn dash(self) -> &'static str {
        match self {
            Self::Setpoint => "",
            Self::SetpointDashed => "5 3",
            Self::Numbered(n) => DASHES.get(n % Self::COUNT).copied().unwrap_or(""),
        }
    }

    /// Line width (px).
    pub(super) const fn width(self) -> f64 {
        match self {
            Self::Setpoint | Self::SetpointDashed => 1.2,
            // Dots carry less ink than dashes.
            Self::Numbered(n) => {
                if n % Self::COUNT == 2 {
                    2.2
                } else {
                    1.8
                }
            }
        }
    }

    /// Index of the marker shape in figures that mark their points.
    pub(super) const fn marker(self) -> usize {
        match self {
            Self::Setpoint | Self::SetpointDashed => 0,
            Self::Numbered(n) => n % 4,
        }
    }
}

/// What a painted thing is, and with it its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) enum Role {
    /// Text, axes, frames.
    Ink,
    /// Secondary text.
    Muted,
    /// Grid lines.
    Grid,
    /// The ground the figure stands on.
    Paper,
    /// Commanded values.
    Setpoint,
    /// Tolerance bands.
    Band,
    /// Faces of blocks and bodies in diagrams.
    Face,
    /// Numbered series.
    Series(usize),
    /// A colour that carries data and is the same in light and dark pages.
    Fixed(Rgb),
    /// Not painted.
    None,
}

/// A colour, one byte per channel.
pub(super) type Rgb = [u8; 3];

/// Okabe-Ito, ordered for lines on white: the yellow is left out, it vanishes on paper.
const SERIES: [(&str, &str); SeriesStyle::COUNT] = [
    ("#0072b2", "#56b4e9"),
    ("#d55e00", "#ff8f45"),
    ("#009e73", "#2fc79b"),
    ("#b8558f", "#e39cc5"),
    ("#c98500", "#e69f00"),
    ("#3a9bd6", "#9ad4f5"),
    ("#3c3c3c", "#d0d0d0"),
];

const PLAIN: [(Role, &str, &str, &str); 7] = [
    (Role::Ink, "ink", "#1a1a1a", "#e8e8e8"),
    (Role::Muted, "muted", "#555555", "#b0b0b0"),
    (Role::Grid, "grid", "#dcdcdc", "#3a3a3a"),
    (Role::Paper, "paper", "#ffffff", "transparent"),
    (Role::Setpoint, "setpoint", "#767676", "#9c9c9c"),
    (Role::Band, "band", "#8a8a8a", "#9a9a9a"),
    (Role::Face, "face", "#f1f4f7", "#262b31"),
];

impl Role {
    /// Name of the CSS variable without `--figure-`; `None` for colours that do not follow the page.
    pub(super) fn variable(self) -> Option<String> {
        match self {
            Self::Series(n) => Some(format!("series-{}", n % SeriesStyle::COUNT + 1)),
            Self::Fixed(_) | Self::None => None,
            plain => PLAIN.iter().find(|row| row.0 == plain).map(|row| row.1.to_owned()),
        }
    }

    /// The colour in a stand-alone file.
    pub(super) fn fallback(self) -> String {
        match self {
            Self::Series(n) => {
                SERIES.get(n % SeriesStyle::COUNT).map_or("#000000", |row| row.0).to_owned()
            }
            Self::Fixed([r, g, b]) => format!("#{r:02x}{g:02x}{b:02x}"),
            Self::None => "none".to_owned(),
            plain => {
                PLAIN.iter().find(|row| row.0 == plain).map_or("#000000", |row| row.2).to_owned()
            }
        }
    }
}

/// Style sheet for a page that shows figures inline: light, dark and print colours.
///
/// Without it the figures keep their stand-alone colours on white. A page with a switch of its own may
/// put `data-theme="dark"` or `data-theme="light"` on its root element.
#[must_use]
pub fn page_style() -> String {
    let mut light = String::new();
    let mut dark = String::new();
    for (role, name, on_light, on_dark) in PLAIN {
        // The page has a ground of its own.
        let on_light = if role == Role::Paper { "transparent" } else { on_light };
        light.push_str(&format!("--figure-{name}:{on_light};"));
        dark.push_str(&format!("--figure-{name}:{on_dark};"));
    }
    for (n, (on_light, on_dark)) in SERIES.iter().enumerate() {
        light.push_str(&format!("--figure-series-{}:{on_light};", n + 1));
        dark.push_str(&format!("--figure-series-{}:{on_dark};", n + 1));
    }
    format!(
        ":root{{{light}}}\n\
         @media screen and (prefers-color-scheme:dark){{:root:not([data-theme=\"light\"]){{{dark}}}}}\n\
         @media screen{{:root[data-theme=\"dark\"]{{{dark}}}}}\n"
    )
}

/// Colour of `value` on the diverging scale from `-limit` to `limit`; white is zero.
///
/// The scale is uniform in the lightness and chroma of OKLab, with equally dark ends; blue and
/// orange-brown stay apart for all common kinds of colour blindness.
pub(super) fn diverging(value: f64, limit: f64) -> Rgb {
    let ratio =
        if limit > 0.0 && value.is_finite() { (value / limit).clamp(-1.0, 1.0) } else { 0.0 };
    stop(&DIVERGING, (ratio + 1.0) / 2.0)
}

/// The colour at a part, from 0 to 1, of the way along equally spaced stops.
fn stop(stops: &[Rgb], part: f64) -> Rgb {
    let position = part * (stops.len() - 1) as f64;
    let index = (position.floor() as usize).min(stops.len() - 2);
    let part = position - index as f64;
    let (low, high) = (stops[index], stops[index + 1]);
    let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * part).round() as u8;
    [mix(low[0], high[0]), mix(low[1], high[1]), mix(low[2], high[2])]
}

/// Colour of a part from 0 to 1 on the scale from light to dark; uniform in the lightness of OKLab,
/// from yellow over green to blue, so that it also reads in grey.
pub(super) fn sequential(part: f64) -> Rgb {
    stop(&SEQUENTIAL, if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.0 })
}

/// True where black text reads better than white on `colour`.
pub(super) fn wants_dark_text([r, g, b]: Rgb) -> bool {
    0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b) > 140.0
}

/// Seventeen stops: OKLab lightness from 0.965 to 0.405, hue from 105 deg to 255 deg.
const SEQUENTIAL: [Rgb; 17] = [
    [247, 246, 211],
    [230, 237, 193],
    [211, 229, 178],
    [188, 221, 167],
    [164, 213, 159],
    [137, 205, 155],
    [109, 197, 154],
    [78, 187, 155],
    [44, 177, 156],
    [0, 165, 158],
    [0, 153, 158],
    [0, 140, 156],
    [0, 126, 152],
    [0, 113, 146],
    [25, 99, 137],
    [38, 86, 126],
    [44, 74, 113],
];

/// Thirty-three stops: OKLab lightness from 0.46 over 0.975 to 0.46, chroma linear, hue 250 deg and 52 deg.
const DIVERGING: [Rgb; 33] = [
    [10, 90, 154],
    [34, 100, 160],
    [50, 109, 166],
    [65, 119, 173],
    [79, 129, 179],
    [93, 138, 185],
    [107, 148, 190],
    [121, 158, 196],
    [134, 167, 202],
    [148, 177, 208],
    [162, 187, 213],
    [176, 197, 219],
    [190, 207, 225],
    [204, 217, 230],
    [218, 227, 236],
    [232, 237, 241],
    [247, 247, 247],
    [240, 235, 232],
    [234, 223, 217],
    [228, 211, 202],
    [221, 200, 187],
    [215, 188, 173],
    [208, 177, 159],
    [201, 165, 144],
    [194, 154, 130],
    [188, 143, 116],
    [181, 132, 102],
    [174, 120, 88],
    [167, 109, 74],
    [159, 98, 59],
    [152, 87, 44],
    [145, 76, 27],
    [137, 65, 1],
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbered_styles_differ_in_dash_and_in_colour() {
        for a in 0..SeriesStyle::COUNT {
            for b in 0..a {
                let (a, b) = (SeriesStyle::Numbered(a), SeriesStyle::Numbered(b));
                assert_ne!(a.dash(), b.dash());
                assert_ne!(a.role().fallback(), b.role().fallback());
            }
        }
    }

    #[test]
    fn the_diverging_scale_is_white_at_zero_and_survives_nonsense() {
        assert!(diverging(0.0, 5.0).iter().all(|channel| *channel > 240));
        assert_eq!(diverging(f64::NAN, 5.0), diverging(0.0, 5.0));
        assert_eq!(diverging(9.0, 0.0), diverging(0.0, 5.0));
        assert_eq!(diverging(-1e300, 1.0), diverging(-1.0, 1.0));
    }
}
