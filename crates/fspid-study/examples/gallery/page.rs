//! A page of a loop analysis; its numbers stand for those that a study would compute.

use fspid_study::figure::Svg;
use fspid_study::report::analysis::{
    AnalysisPage, Chapter, DataTable, Datum, Item, Picture, Provenance, Standing, Verdict,
};

/// The page of an analysis with these figures.
pub(crate) fn page(figures: &[(&'static str, Svg)]) -> String {
    let picture = |wanted: &str, caption: &str| {
        let found = figures.iter().find(|(name, _)| *name == wanted);
        found.map(|(name, svg)| Picture {
            name: (*name).to_owned(),
            svg: svg.clone(),
            caption: caption.to_owned(),
        })
    };
    let figure = |name: &str, caption: &str| picture(name, caption).map(Item::Figure);
    let verdict = |standing, word: &str, name: &str, detail: &str| Verdict {
        standing,
        word: word.to_owned(),
        name: name.to_owned(),
        detail: detail.to_owned(),
    };
    let chapter = |id: &str, title: &str, items: Vec<Option<Item>>| Chapter {
        id: id.to_owned(),
        title: title.to_owned(),
        items: items.into_iter().flatten().collect(),
    };
    let number = |text: &str| Datum::Number(text.to_owned());
    let margins = DataTable {
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
    };
    AnalysisPage {
        title: "gallery: loop analysis".to_owned(),
        heading: "Boeing 747 with servo, 20 Hz".to_owned(),
        lead: "Loop analysis of a sampled loop. Angles are in degrees, frequencies in rad/s."
            .to_owned(),
        verdicts: vec![
            verdict(
                Standing::Good,
                "Stable",
                "CPID",
                "Gain margin 19.6 dB, phase margin 54.7 deg.",
            ),
            verdict(
                Standing::Bad,
                "REFUTED standing still",
                "FSPID",
                "Frozen at e = 5 deg, ec = -1.25 deg, it is unstable; in flight it may still settle.",
            ),
            verdict(Standing::Fair, "Open", "FSPID, box of gains", "99 of 144 boxes are proved."),
        ],
        warnings: vec!["Saturation of the elevator is not covered.".to_owned()],
        requirements: Some((margins, false)),
        chapters: vec![
            chapter(
                "responses",
                "Frequency responses",
                vec![
                    Some(Item::Text("The loop is broken at the elevator command.".to_owned())),
                    figure("analysis-bode", "Gain and phase with their margins."),
                    picture("analysis-nyquist", "Near the critical point.")
                        .zip(picture("analysis-nichols", "With the region of MIL-F-9490D."))
                        .map(|(a, b)| Item::Figures(vec![a, b])),
                    figure("analysis-sensitivity", "Peaks tell how near the loop comes to -1."),
                ],
            ),
            chapter(
                "poles",
                "Poles",
                vec![
                    figure("analysis-root-locus", "Poles over the loop gain."),
                    figure("analysis-poles", "Poles and zeros."),
                ],
            ),
            chapter(
                "frozen",
                "Gains frozen",
                vec![
                    Some(Item::Warning(
                        "A map of frozen gains proves nothing about moving ones.".to_owned(),
                    )),
                    picture("analysis-map", "Over the inputs of the supervisor.")
                        .zip(picture("analysis-surface", "The same on the surface of a gain."))
                        .map(|(a, b)| Item::Figures(vec![a, b])),
                    figure("analysis-radius", "Along a flight."),
                ],
            ),
            chapter(
                "certificate",
                "Certificate",
                vec![figure("analysis-gain-set", "What is proved, and what is not.")],
            ),
        ],
        provenance: Provenance {
            command: "cargo run -p fspid-study --example gallery -- FOLDER".to_owned(),
            ..Provenance::default()
        },
    }
    .render()
}
