//! probe
use std::time::Instant;
use fspid_study::file::*;
fn main(){
 let text=std::fs::read_to_string("scenarios/747-pitch-step.toml").unwrap();
 let head=text.split("[[controller]]").next().unwrap(); let last=text.split("[[controller]]").last().unwrap();
 let text=format!("{head}[[controller]]{last}").replace("duration_s = 20.0","duration_s = 50.0");
 let req=std::env::args().nth(1).unwrap_or_default();
 let text=format!("{text}{req}");
 let t=Template::parse(&text,"x",None,&Extra::default()).unwrap_or_else(|e| panic!("{e}"));
 let p=SettingPath::parse("plant.preset.numerator[0]").unwrap();
 for _ in 0..3 {
 let s=Instant::now();
 let studies:Vec<_>=(0..1000).map(|i| t.with(&[(&p,NewValue::Number(-1.69*(0.8+0.0004*i as f64)))]).unwrap()).collect();
 let a=s.elapsed().as_secs_f64();
 let s=Instant::now();
 let pr:Vec<_>=studies.iter().map(|s| s.scenario.prepare().unwrap()).collect();
 let b=s.elapsed().as_secs_f64(); drop(pr);
 let s=Instant::now();
 let mut n=0; for c in studies.chunks(8){ n+=fspid_campaign::engine::fly(c).len(); }
 let c=s.elapsed().as_secs_f64();
 println!("build {:.1} us prepare {:.1} us fly+measure {:.1} us  ({n})",a*1e3,b*1e3,c*1e3);
 }
}
