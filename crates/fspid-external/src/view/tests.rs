use super::*;

const TRACE: &str = "time_s,setpoint_deg,PID.theta_deg,PID.elevator_deg,PID.airspeed_m_s,PID.altitude_m,PID.alpha_deg,PID.bank_deg\n0.0,0.0,0.0,-5.0,100.0,1000.0,2.5,0.0\n0.5,1.0,1.5,-6.0,100.0,1001.0,3.0,-1.0\n1.0,1.0,,,,,,\n";
const START: Start = Start {
    latitude_deg: 60.0,
    longitude_deg: 10.0,
    heading_deg: 90.0,
    altitude_m: 0.0,
    airspeed_m_s: 1.0,
};

#[test]
fn a_trace_becomes_poses_along_its_course_until_the_flight_ends() {
    let poses = poses(TRACE, Some("PID"), &START).expect("a flight");
    assert_eq!(poses.len(), 2);
    assert!((poses[1].pitch_deg - 4.0).abs() < 1e-12 && (poses[0].pitch_deg - 2.5).abs() < 1e-12);
    // 50 m to the east, where a degree of longitude is half of one at the equator: 111.195 km.
    let east_m = (poses[1].longitude_deg - 10.0) * 111_195.08 * 0.5;
    assert!((east_m - 50.0).abs() < 1e-3, "{east_m}");
    assert!((poses[1].latitude_deg - 60.0).abs() < 1e-12);
}

/// North of the flight is east of the map where it is turned by a right angle.
#[test]
fn a_trace_that_knows_its_way_goes_along_it_turned_by_the_heading_that_is_given() {
    let text = "time_s,theta_deg,elevator_deg,airspeed_m_s,alpha_deg,north_m,east_m,heading_deg,attitude_deg\n\
                0,0,-1,50,2,100,-50,0,3\n1,1,-1,50,2,140,-20,-10,4.5\n";
    let [first, then] = poses(text, None, &START).expect("a flight")[..] else { panic!("two") };
    assert!(
        (first.latitude_deg - 60.0).abs() < 1e-12 && (first.longitude_deg - 10.0).abs() < 1e-12
    );
    let east_m = (then.longitude_deg - 10.0) * 111_195.08 * 0.5;
    let north_m = (then.latitude_deg - 60.0) * 111_195.08;
    assert!((east_m - 40.0).abs() < 1e-3 && (north_m + 30.0).abs() < 1e-3, "{north_m} {east_m}");
    assert_eq!((first.heading_deg, then.heading_deg), (90.0, 80.0));
    assert_eq!((first.pitch_deg, then.pitch_deg), (3.0, 4.5));
}

#[test]
fn a_flight_is_shown_live_as_its_trace_would_be() {
    use fspid_sim::signal::{Profile, Shape};
    use fspid_sim::{ElevatorSign, LinearPlant, Scenario, Timing};
    let listener = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let viewers = [(Viewer::XPlane, listener.local_addr().expect("an address"))];
    let plant = LinearPlant::new(&[1.0], &[1.0, 0.0], ElevatorSign::NoseUpPositive).expect("one");
    let timing = Timing::new(0.01, 0.05).expect("a timing");
    let setpoint = Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("a profile");
    let scenario = Scenario::new("", plant, timing, setpoint);
    let prepared = scenario.prepare().expect("prepared");
    let mut live = Live::new(START, timing, &viewers, [1.0, 50.0]).expect("a socket");
    let outcome = fspid_sim::fly_commanded(
        &prepared,
        |_| 1.0,
        |instant| {
            live.show(&instant).expect("sent");
            std::ops::ControlFlow::Continue(())
        },
    );
    assert!(outcome.is_ok());
    // Six samples, every second one.
    assert_eq!(live.shown().sent, 3);
    let mut bytes = [0; 64];
    let mut pitch = || {
        let size = listener.recv(&mut bytes).expect("a packet");
        assert_eq!(size, 45);
        f32::from_le_bytes(bytes[37..41].try_into().expect("4 bytes"))
    };
    // A radian a second.
    for expected in [0.0_f32, 0.02, 0.04] {
        assert!((pitch() - expected.to_degrees()).abs() < 1e-5);
    }
}

#[test]
fn a_trace_that_cannot_be_shown_says_what_is_wrong_and_what_is_allowed() {
    let told =
        |text: &str, name: Option<&str>| poses(text, name, &START).expect_err("wrong").to_string();
    assert!(told(TRACE, None).contains("allowed is --controller with one of PID"));
    assert!(told("a,b\n1,2\n", None).contains("no column `time_s`"));
    assert!(told("time_s,theta_deg,elevator_deg\n", None).contains("no sample"));
    assert!(
        told("time_s,theta_deg,elevator_deg\n0,NaN,1\n", None)
            .contains("line 2, theta_deg: `NaN` is no number")
    );
    assert!(
        told("time_s,theta_deg,elevator_deg\n0,1,1\n0,1,1\n", None)
            .contains("line 3: its time is not behind")
    );
}

#[test]
fn a_line_for_flightgear_has_a_number_for_each_chunk_of_its_file() {
    let pose = Pose {
        altitude_m: 304.8,
        pitch_deg: -2.5,
        airspeed_m_s: 51.444_444_444,
        ..Pose::default()
    };
    let line = String::from_utf8(Viewer::FlightGear.packet(&pose)).expect("text");
    let fields: Vec<f64> =
        line.trim_end().split(',').map(|it| it.parse().expect("a number")).collect();
    let file = flightgear_protocol();
    let chunks: Vec<&str> = file.lines().filter(|line| line.contains("<chunk>")).collect();
    assert_eq!(fields.len(), chunks.len());
    let of =
        |node: &str| fields[chunks.iter().position(|line| line.contains(node)).expect("a chunk")];
    assert!((of("/position/altitude-ft") - 1000.0).abs() < 1e-6);
    assert!((of("/orientation/pitch-deg") + 2.5).abs() < 1e-9);
    assert!((of("/velocities/airspeed-kt") - 100.0).abs() < 1e-6);
    assert!(roxmltree::Document::parse(&file).is_ok());
}

#[test]
fn a_message_for_x_plane_has_its_45_bytes_in_the_order_of_its_fields() {
    let pose = Pose {
        latitude_deg: 47.5,
        longitude_deg: -122.25,
        altitude_m: 900.0,
        heading_deg: 90.0,
        pitch_deg: 3.5,
        bank_deg: -1.0,
        ..Pose::default()
    };
    let bytes = Viewer::XPlane.packet(&pose);
    assert_eq!((bytes.len(), &bytes[..9]), (45, &b"VEHX\0\0\0\0\0"[..]));
    let double = |at: usize| f64::from_le_bytes(bytes[at..at + 8].try_into().expect("8 bytes"));
    let single = |at: usize| f32::from_le_bytes(bytes[at..at + 4].try_into().expect("4 bytes"));
    assert_eq!(
        [double(9), double(17), double(25)].map(f64::to_bits),
        [47.5_f64, -122.25, 900.0].map(f64::to_bits)
    );
    assert_eq!(
        [single(33), single(37), single(41)].map(f32::to_bits),
        [90.0_f32, 3.5, -1.0].map(f32::to_bits)
    );
}

#[test]
fn every_pose_that_fits_into_the_rate_arrives_and_so_does_the_last() {
    let listener = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address");
    let pose =
        |k: u32| Pose { time_s: 0.01 * f64::from(k), pitch_deg: f64::from(k), ..Pose::default() };
    let flown: Vec<Pose> = (0..=10).map(pose).collect();
    // 25 poses a second of a flight that has 100: every fourth, and the last.
    let shown = show(&flown, &[(Viewer::XPlane, address)], 1.0, 25.0).expect("sent");
    assert_eq!(shown.sent, 4);
    let mut pitches = Vec::new();
    let mut bytes = [0; 64];
    for _ in 0..shown.sent {
        let size = listener.recv(&mut bytes).expect("a packet");
        assert_eq!(size, 45);
        pitches.push(f32::from_le_bytes(bytes[37..41].try_into().expect("4 bytes")));
    }
    assert_eq!(pitches, [0.0, 4.0, 8.0, 10.0]);
}

#[test]
fn a_line_that_ends_before_its_last_column_is_no_end_of_the_flight() {
    let lines: Vec<&str> = TRACE.trim_end().lines().collect();
    for damaged in ["garbage", "0.1", ",,"] {
        let mut text = lines.clone();
        text.insert(2, damaged);
        let wrong = poses(&text.join("\n"), Some("PID"), &START).expect_err("damaged");
        assert!(matches!(wrong, TraceError::TooShort { line: 3, .. }), "{damaged}: {wrong}");
        assert!(wrong.to_string().contains("is damaged, or is still being written"), "{wrong}");
    }
}
