//! Writes one figure of each kind into a folder: `cargo run -p fspid-study --example gallery -- FOLDER`.
use std::error::Error;
use std::path::PathBuf;

use fspid_plot::{
    Band, LineFigure, LinePanel, Mark, RatioFigure, RuleTable, SEVEN, Series, SeriesStyle, Surface,
    SurfaceKind, Svg, diagrams, memberships, page_style,
};

#[path = "gallery/analysis.rs"]
mod analysis;
#[path = "gallery/campaign.rs"]
mod campaign;
#[path = "gallery/page.rs"]
mod page;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("the folder to write to is missing")?);
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join("page.css"), page_style())?;
    let figures = [
        ("response", response()),
        ("memberships-inputs", inputs()),
        ("memberships-outputs", outputs()),
        ("surface-view", surface().render(SurfaceKind::View)),
        ("surface-map", surface().render(SurfaceKind::Map)),
        ("rules", rules()),
        ("ratio", ratio()),
        ("axes", diagrams::aircraft_axes()),
        ("pitch-loop", diagrams::pitch_loop()),
        ("self-tuning-pid", diagrams::self_tuning_pid()),
    ];
    let loops = analysis::figures()?;
    std::fs::write(folder.join("analysis.html"), page::page(&loops))?;
    for (name, svg) in figures.into_iter().chain(loops).chain(campaign::figures()) {
        std::fs::write(folder.join(format!("{name}.svg")), svg.as_str())?;
    }
    Ok(())
}

fn time(n: u32, dt_s: f64) -> Vec<f64> {
    (0..n).map(|k| f64::from(k) * dt_s).collect()
}

fn series(name: &str, style: SeriesStyle, x: &[f64], y: impl Fn(f64) -> f64) -> Series {
    Series {
        name: name.to_owned(),
        style,
        x: x.to_vec(),
        y: x.iter().map(|t| y(*t)).collect(),
        stairs: false,
    }
}

fn panel(y_label: &str, series: Vec<Series>) -> LinePanel {
    LinePanel {
        y_label: y_label.to_owned(),
        x_label: "time [s]".to_owned(),
        series,
        ..LinePanel::default()
    }
}

fn response() -> Svg {
    let t = time(2001, 0.01);
    let line = |name: &str, style, y: &dyn Fn(f64) -> f64| series(name, style, &t, y);
    let settle = |t: f64, a: f64, w: f64| (-a * t).exp() * ((w * t).cos() + a / w * (w * t).sin());
    let [fspid, cpid, pc, kp, ki, kd] = [0, 1, 2, 3, 4, 5].map(SeriesStyle::Numbered);
    let mut pitch = panel(
        "pitch angle [deg]",
        vec![
            line("set-point", SeriesStyle::Setpoint, &|_| 1.0),
            line("FSPID", fspid, &|t| 1.0 - settle(t, 1.2, 0.6)),
            line("CPID, same nominal gains", cpid, &|t| 1.0 - settle(t, 0.5, 1.4)),
            line("PC", pc, &|t| 1.0 - settle(t, 0.12, 1.9)),
        ],
    );
    pitch.bands.push(Band { label: "\u{b1}2 % band".to_owned(), lower: 0.98, upper: 1.02 });
    let command = panel(
        "elevator command [deg]",
        vec![
            line("FSPID", fspid, &|t| 2.0 * settle(t, 1.2, 0.6) + 0.1),
            line("CPID, same nominal gains", cpid, &|t| 1.5 * settle(t, 0.5, 1.4) + 0.1),
        ],
    );
    let gains = panel(
        "gains of the FSPID",
        vec![
            line("k_{p}", kp, &|t| 2.0 + 0.8 * (-0.9 * t).exp()),
            line("k_{i} [1/s]", ki, &|t| 0.5 - 0.2 * (-0.5 * t).exp()),
            line("k_{d} [s]", kd, &|t| 1.0 - 0.4 * settle(t, 1.5, 2.0)),
        ],
    );
    let title = "Step response of the 747 with rate-gyro loop".to_owned();
    LineFigure { title, panels: vec![pitch, command, gains], width_px: 720.0 }.render()
}

fn centres() -> impl Iterator<Item = (String, f64)> {
    SEVEN.iter().enumerate().map(|(n, label)| ((*label).to_owned(), (n as f64 - 3.0) * 5.0 / 3.0))
}

fn values(from: f64, to: f64, n: u32) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * f64::from(k) / f64::from(n)).collect()
}

fn inputs() -> Svg {
    let gaussian = |x: f64, centre: f64| (-(x - centre).powi(2) / (2.0 * 0.7078_f64.powi(2))).exp();
    let points = |centre: f64| {
        values(-5.0, 5.0, 400).into_iter().map(|x| (x, gaussian(x, centre))).collect()
    };
    memberships(
        "Inputs of the supervisor",
        "error e [deg], change of error ec [deg/s]",
        centres().map(|(label, c)| (label, points(c))).collect(),
    )
}

fn outputs() -> Svg {
    let points = |c: f64| {
        let corners = [(c - 5.0 / 3.0, 0.0), (c, 1.0), (c + 5.0 / 3.0, 0.0)];
        corners.into_iter().filter(|p| p.0.abs() < 5.01).collect()
    };
    memberships(
        "Outputs of the supervisor",
        "increments \u{394}k_{p}, \u{394}k_{i}, \u{394}k_{d}",
        centres().map(|(label, c)| (label, points(c))).collect(),
    )
}

fn surface() -> Surface {
    let nodes = values(-5.0, 5.0, 60);
    let value = |e: f64, ec: f64| {
        -4.2 * ((1.3 * e + ec) / 6.0).tanh() + 0.5 * (1.1 * e).cos() * (0.6 * ec).cos()
    };
    Surface {
        title: "Increment of the proportional gain".to_owned(),
        x_label: "error e [deg]".to_owned(),
        y_label: "change ec [deg/s]".to_owned(),
        z_label: "\u{394}k_{p}".to_owned(),
        values: nodes.iter().map(|ec| nodes.iter().map(|e| value(*e, *ec)).collect()).collect(),
        xs: nodes.clone(),
        ys: nodes,
        limit: None,
    }
}

fn rules() -> Svg {
    let rows = [
        "PS NM NB NB NB NM PS",
        "PS NS NB NM NM NS PS",
        "ZO NS NM NM NS NS ZO",
        "ZO NS NS NS NS NS ZO",
        "ZO NS ZO ZO ZO ZO PS",
        "PB NS PS PS PS PS PB",
        "PB PM PM PM PS PS PB",
    ];
    let mark = |row, column, reason: &str| Mark { row, column, reason: reason.to_owned() };
    RuleTable {
        title: "Rules for \u{394}k_{d} (Table 3)".to_owned(),
        row_header: "error e".to_owned(),
        column_header: "change of error ec".to_owned(),
        labels: SEVEN.map(str::to_owned).to_vec(),
        cells: rows.iter().map(|row| row.split(' ').map(str::to_owned).collect()).collect(),
        shades: Vec::new(),
        marked: vec![
            mark(5, 1, "breaks the symmetry of its row: the mirrored cell says PS"),
            mark(4, 1, "breaks the symmetry of its row: the mirrored cell says PS"),
            mark(0, 6, "printed with a doubled slash"),
        ],
    }
    .render()
}

fn ratio() -> Svg {
    let sizes = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0];
    let line = |name: &str, n, f: fn(f64) -> f64| series(name, SeriesStyle::Numbered(n), &sizes, f);
    RatioFigure {
        title: "Cost of the FSPID over that of the CPID, abrupt disturbance".to_owned(),
        x_label: "size of the disturbance [deg]".to_owned(),
        y_label: "ratio of IAE (below 1: FSPID better)".to_owned(),
        series: vec![
            line("same nominal gains, at the elevator", 0, |x| 0.62 + 0.1 * x.ln().sin()),
            line("re-tuned, at the elevator", 1, |x| 1.04 + 0.05 * x.ln()),
            line("same nominal gains, at the servo", 2, |x| 0.8 - 0.04 * x.ln()),
            line("re-tuned, at the servo", 3, |x| 1.2 + 0.1 * x.ln()),
        ],
        log_x: true,
        log_y: true,
        reference: Some((1.0, "equal cost".to_owned())),
        width_px: 720.0,
    }
    .render()
}
