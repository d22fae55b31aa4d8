use fspid_proof::*;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let overrides: Vec<String> = args[5..].to_vec();
    let study = fspid_study::file::load(std::path::Path::new(&args[1]), &overrides).unwrap();
    let named = study.scenario.controllers.iter().find(|n| n.name == args[2]).unwrap();
    let plants = study.scenario.lasting_plants();
    let plant = &plants[0].1;
    let d = LoopDescription::of(&study.scenario, plant, &named.controller).unwrap();
    for f in args[3].split(',') {
        for c in args[4].split(',') {
            let t = std::time::Instant::now();
            let s = probe(&d, &Effort::default(), f.parse().unwrap(), c.parse().unwrap());
            println!("{f} {c}: {s} {:.2} s", t.elapsed().as_secs_f64());
        }
    }
}
