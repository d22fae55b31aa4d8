//! The pitch loop and the self-tuning PID as block diagrams.

use super::blocks::{Block, SUM, arrow, node, note, signal, sum, wire};
use crate::page;
use crate::svg::{Anchor, Canvas, Svg};

/// Height of the main line of the pitch loop.
const LOOP_Y: f64 = 104.0;
/// Height of the main line of the self-tuning PID.
const TUNING_Y: f64 = 268.0;

/// The pitch control loop with servo, elevator sign, vertical gyro and rate gyro (Fig. 2).
#[must_use]
pub fn pitch_loop() -> Svg {
    let title = "The pitch loop";
    let mut canvas = Canvas::new(760.0, 296.0);
    page::title(&mut canvas, title);
    pitch_blocks(&mut canvas);
    let y = LOOP_Y;
    let names = [
        (46.0, y - 8.0, "\u{3b8}_{ref}"),
        (117.0, y - 8.0, "e"),
        (240.0, y - 8.0, "u"),
        (567.0, y - 8.0, "\u{3b4}_{e}"),
        (738.0, y - 14.0, "\u{3b8}"),
        (682.0, y + 24.0, "q"),
    ];
    for (x, y, name) in names {
        signal(&mut canvas, (x, y), Anchor::Middle, name);
    }
    let notes = [
        (364.0, 181.0, "inner loop, where fitted"),
        (252.0, y - 36.0, "u > 0: nose up"),
        (567.0, y - 36.0, "\u{3b4}_{e} > 0: trailing edge down"),
    ];
    for (x, y, text) in notes {
        note(&mut canvas, (x, y), Anchor::Middle, text);
    }
    canvas.finish(
        title,
        "Block diagram. The pitch error, reference minus measured pitch, drives the controller; its \
         command, less the rate-gyro signal of the inner loop, drives the elevator servo, a first-order \
         lag. The elevator sign turns nose-up commands into trailing-edge-up deflections of the \
         aircraft. Pitch returns through the vertical gyro.",
    )
}

fn pitch_blocks(canvas: &mut Canvas) {
    let y = LOOP_Y;
    let (outer, inner) = ((98.0, y), (276.0, y));
    let controller = Block::new((178.0, y), (96.0, 52.0), &["controller", "P, PID, FSPID"]);
    let servo = Block::new((372.0, y), (104.0, 52.0), &["elevator servo", "1 / (\u{3c4}s + 1)"]);
    let sign = Block::new((498.0, y), (92.0, 52.0), &["\u{2212}1", "elevator sign"]);
    let aircraft = Block::new((632.0, y + 8.0), (80.0, 68.0), &["aircraft"]);
    let rate = Block::new((498.0, 190.0), (104.0, 34.0), &["rate gyro, K_{r}"]);
    let vertical = Block::new((406.0, 258.0), (104.0, 34.0), &["vertical gyro"]);
    arrow(canvas, &[(30.0, y), (outer.0 - SUM, y)]);
    arrow(canvas, &[(outer.0 + SUM, y), controller.left()]);
    arrow(canvas, &[controller.right(), (inner.0 - SUM, y)]);
    arrow(canvas, &[(inner.0 + SUM, y), servo.left()]);
    arrow(canvas, &[servo.right(), sign.left()]);
    arrow(canvas, &[sign.right(), (aircraft.left().0, y)]);
    // Pitch and pitch rate go back on the right of the aircraft, the rate inside.
    let (pitch_y, rate_y, edge) = (y - 6.0, y + 30.0, aircraft.right().0);
    let (pitch_x, rate_x) = (718.0, 694.0);
    arrow(canvas, &[(edge, pitch_y), (744.0, pitch_y)]);
    arrow(canvas, &[(edge, rate_y), (rate_x, rate_y), (rate_x, rate.centre.1), rate.right()]);
    arrow(canvas, &[rate.left(), (inner.0, rate.centre.1), (inner.0, y + SUM)]);
    node(canvas, (pitch_x, pitch_y));
    arrow(canvas, &[(pitch_x, pitch_y), (pitch_x, vertical.centre.1), vertical.right()]);
    arrow(canvas, &[vertical.left(), (outer.0, vertical.centre.1), (outer.0, y + SUM)]);
    for block in [controller, servo, sign, aircraft, rate, vertical] {
        block.draw(canvas);
    }
    sum(canvas, outer, "+", "\u{2212}");
    sum(canvas, inner, "+", "\u{2212}");
}

/// The adjustable PID whose gains a fuzzy inference corrects (Fig. 3).
#[must_use]
pub fn self_tuning_pid() -> Svg {
    let title = "The fuzzy self-tuning PID";
    let mut canvas = Canvas::new(760.0, 372.0);
    page::title(&mut canvas, title);
    let law = Block::new(
        (390.0, 174.0),
        (196.0, 40.0),
        &["k = k\u{2032} + \u{394}k  for  k_{p}, k_{i}, k_{d}"],
    );
    let pid = Block::new(
        (390.0, TUNING_Y),
        (196.0, 52.0),
        &["adjustable PID", "k_{p} e + k_{i} \u{222b}e + k_{d} \u{117}"],
    );
    tuning_loop(&mut canvas, &pid);
    inference(&mut canvas, &law);
    for (dx, name) in [(-60.0, "k_{p}"), (0.0, "k_{i}"), (60.0, "k_{d}")] {
        let x = law.centre.0 + dx;
        arrow(&mut canvas, &[(x, law.bottom().1), (x, pid.top().1)]);
        signal(&mut canvas, (x + 6.0, 222.0), Anchor::Start, name);
    }
    arrow(&mut canvas, &[(600.0, law.centre.1), law.right()]);
    law.draw(&mut canvas);
    let beside = (606.0, law.centre.1 + 4.5);
    signal(&mut canvas, beside, Anchor::Start, "k_{p}\u{2032}, k_{i}\u{2032}, k_{d}\u{2032}");
    note(&mut canvas, (beside.0, beside.1 + 18.0), Anchor::Start, "nominal gains");
    canvas.finish(
        title,
        "Block diagram. Pitch error e and its change ec enter a fuzzy inference of 49 rules, which gives \
         increments of the three gains. Added to the nominal gains they set an adjustable PID, which \
         turns the error into the command u for servo and aircraft. Pitch returns through the vertical gyro.",
    )
}

/// The loop at the bottom, closed around `pid`.
fn tuning_loop(canvas: &mut Canvas, pid: &Block<'_>) {
    let y = TUNING_Y;
    let error = (104.0, y);
    let plant = Block::new((590.0, y), (104.0, 52.0), &["servo, aircraft"]);
    let gyro = Block::new((390.0, 338.0), (104.0, 34.0), &["vertical gyro"]);
    arrow(canvas, &[(34.0, y), (error.0 - SUM, y)]);
    arrow(canvas, &[(error.0 + SUM, y), pid.left()]);
    arrow(canvas, &[pid.right(), plant.left()]);
    arrow(canvas, &[plant.right(), (744.0, y)]);
    arrow(canvas, &[(694.0, y), (694.0, gyro.centre.1), gyro.right()]);
    arrow(canvas, &[gyro.left(), (error.0, gyro.centre.1), (error.0, y + SUM)]);
    for block in [*pid, plant, gyro] {
        block.draw(canvas);
    }
    sum(canvas, error, "+", "\u{2212}");
    node(canvas, (694.0, y));
    for (x, name) in [(52.0, "\u{3b8}_{ref}"), (132.0, "e"), (512.0, "u"), (722.0, "\u{3b8}")] {
        signal(canvas, (x, y - 8.0), Anchor::Middle, name);
    }
}

/// The inference at the top: its two inputs from the error, its three outputs into `law`.
fn inference(canvas: &mut Canvas, law: &Block<'_>) {
    let fuzzy =
        Block::new((390.0, 76.0), (196.0, 60.0), &["fuzzy inference", "49 rules, centroid"]);
    let change = Block::new((224.0, 92.0), (56.0, 28.0), &["change"]);
    let (from, upper, lower) = ((152.0, TUNING_Y), 60.0, change.centre.1);
    node(canvas, from);
    node(canvas, (from.0, lower));
    arrow(canvas, &[from, (from.0, upper), (fuzzy.left().0, upper)]);
    wire(canvas, &[(from.0, lower), change.left()]);
    arrow(canvas, &[change.right(), (fuzzy.left().0, lower)]);
    signal(canvas, (274.0, upper - 6.0), Anchor::Middle, "e");
    signal(canvas, (270.0, lower - 6.0), Anchor::Middle, "ec");
    for (dx, name) in [(-60.0, "\u{394}k_{p}"), (0.0, "\u{394}k_{i}"), (60.0, "\u{394}k_{d}")] {
        let x = fuzzy.centre.0 + dx;
        arrow(canvas, &[(x, fuzzy.bottom().1), (x, law.top().1)]);
        signal(canvas, (x + 6.0, 134.0), Anchor::Start, name);
    }
    fuzzy.draw(canvas);
    change.draw(canvas);
}
