//! A page of a loop analysis; its numbers stand for those that a study would compute.

use fspid_page::analysis::{
    AnalysisPage, Chapter, DataTable, Datum, Item, Picture, Provenance, Standing, Verdict,
};
use fspid_plot::Svg;

/// The figures that there are, by name.
struct Figures<'a>(&'a [(&'static str, Svg)]);

impl Figures<'_> {
    fn picture(&self, wanted: &str, caption: &str) -> Option<Picture> {
        let found = self.0.iter().find(|(name, _)| *name == wanted);
        found.map(|(name, svg)| Picture {
            name: (*name).to_owned(),
            svg: svg.clone(),
            caption: caption.to_owned(),
        })
    }

    fn item(&self, name: &str, caption: &str) -> Option<Item> {
        self.picture(name, caption).map(Item::Figure)
    }
}

/// The page of an analysis with these figures.
pub(crate) fn page(figures: &[(&'static str, Svg)]) -> String {
    let figures = Figures(figures);
    AnalysisPage {
        title: "gallery: loop analysis".to_owned(),
        heading: "Boeing 747 with servo, 20 Hz".to_owned(),
        lead: "Loop analysis of a sampled loop. Angles are in degrees, frequencies in rad/s."
            .to_owned(),
        verdicts: verdicts(),
        warnings: Vec::new(),
        beside: vec!["Saturation of the elevator is not covered.".to_owned()],
        requirements: Some((margins(), false)),
        chapters: Vec::from([responses, poles, frozen, certificate].map(|it| it(&figures))),
        provenance: Provenance {
            command: "cargo run -p fspid-study --example gallery -- FOLDER".to_owned(),
            ..Provenance::default()
        },
    }
    .render()
}

fn verdicts() -> Vec<Verdict> {
    let verdict = |standing, word: &str, name: &str, detail: &str| Verdict {
        standing,
        word: word.to_owned(),
        name: name.to_owned(),
        detail: detail.to_owned(),
    };
    vec![
        verdict(Standing::Good, "Stable", "CPID", "Gain margin 19.6 dB, phase margin 54.7 deg."),
        verdict(
            Standing::Bad,
            "REFUTED standing still",
            "FSPID",
            "Frozen at e = 5 deg, ec = -1.25 deg, it is unstable; in flight it may still settle.",
        ),
        verdict(Standing::Fair, "Open", "FSPID, box of gains", "99 of 144 boxes are proved."),
    ]
}

fn margins() -> DataTable {
    let number = |text: &str| Datum::Number(text.to_owned());
    DataTable {
        caption: "Margins of the sampled loop, broken at the elevator command.".to_owned(),
        head: [
            "controller",
            "gain margin [dB]",
            "phase margin [deg]",
            "disk margin",
            "6 dB and 45 deg",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: vec![
            vec![
                Datum::Text("FSPID at rest".to_owned()),
                number("17.5"),
                number("73.6"),
                number("1.17"),
                Datum::Met("met".to_owned()),
            ],
            vec![
                Datum::Text("CPID".to_owned()),
                number("19.6"),
                number("54.7"),
                number("0.922"),
                Datum::Met("met".to_owned()),
            ],
            vec![
                Datum::Text("CPID, gains times 14".to_owned()),
                Datum::Failing("no margins: the closed loop is unstable".to_owned(), 3),
                Datum::Unmet("NOT MET".to_owned()),
            ],
        ],
        cards: true,
    }
}

fn chapter(id: &str, title: &str, items: Vec<Option<Item>>) -> Chapter {
    Chapter {
        id: id.to_owned(),
        title: title.to_owned(),
        items: items.into_iter().flatten().collect(),
    }
}

fn responses(figures: &Figures<'_>) -> Chapter {
    chapter(
        "responses",
        "Frequency responses",
        vec![
            Some(Item::Text("The loop is broken at the elevator command.".to_owned())),
            figures.item("analysis-bode", "Gain and phase with their margins."),
            figures
                .picture("analysis-nyquist", "Near the critical point.")
                .zip(figures.picture("analysis-nichols", "With the region of MIL-F-9490D."))
                .map(|(a, b)| Item::Figures(vec![a, b])),
            figures.item("analysis-sensitivity", "Peaks tell how near the loop comes to -1."),
        ],
    )
}

fn poles(figures: &Figures<'_>) -> Chapter {
    chapter(
        "poles",
        "Poles",
        vec![
            figures.item("analysis-root-locus", "Poles over the loop gain."),
            figures.item("analysis-poles", "Poles and zeros."),
        ],
    )
}

fn frozen(figures: &Figures<'_>) -> Chapter {
    chapter(
        "frozen",
        "Gains frozen",
        vec![
            Some(Item::Warning(
                "A map of frozen gains proves nothing about moving ones.".to_owned(),
            )),
            figures
                .picture("analysis-map", "Over the inputs of the supervisor.")
                .zip(figures.picture("analysis-surface", "The same on the surface of a gain."))
                .map(|(a, b)| Item::Figures(vec![a, b])),
            figures.item("analysis-radius", "Along a flight."),
        ],
    )
}

fn certificate(figures: &Figures<'_>) -> Chapter {
    chapter(
        "certificate",
        "Certificate",
        vec![figures.item("analysis-gain-set", "What is proved, and what is not.")],
    )
}
