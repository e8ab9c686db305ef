//! Temporary.
#![allow(dead_code, unused)]
#[path = "../boundary.rs"]
mod boundary;
mod masks;
#[path = "../parallel.rs"]
mod parallel;
use masks::cases::*;
use masks::outcome::*;
use parallel::in_parallel;
use std::collections::BTreeMap;
use std::path::Path;
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let fast = args.iter().any(|a| a == "fast");
    let each = args.iter().any(|a| a == "each");
    let third = args.iter().any(|a| a == "third");
    let mut cases: Vec<Case> = all(Path::new("/work/shared"), false)
        .unwrap()
        .into_iter()
        .filter(|c| {
            matches!(
                c.set,
                Set::Sequences
                    | Set::Generated
                    | Set::Colour
                    | Set::Bare
                    | Set::Pairs
                    | Set::SharedScenes
                    | Set::Robots
                    | Set::Large
            )
        })
        .collect();
    let n = cases.len();
    cases.extend(unseen());
    if third {
        let mut k = 0;
        cases.retain(|c| {
            k += 1;
            c.set != Set::Sequences || k % 3 == 0
        });
    }
    if let Some(only) = args.iter().find_map(|a| a.strip_prefix("only=")) {
        cases.retain(|c| only.split(',').any(|o| c.name.contains(o)));
    }
    if args.iter().any(|a| a == "stages") {
        let mut sums: BTreeMap<String, f64> = BTreeMap::new();
        for c in &cases {
            let data = c.load().unwrap();
            let options = veronese::SegmentOptions {
                quality: if fast { veronese::Quality::Fast } else { veronese::Quality::Best },
                ..Default::default()
            };
            let mut last = (std::time::Instant::now(), String::from("start"));
            let mut add = |name: String, sums: &mut BTreeMap<String, f64>| {
                let now = std::time::Instant::now();
                *sums.entry(std::mem::replace(&mut last.1, name)).or_default() += 1e3 * (now - last.0).as_secs_f64();
                last.0 = now;
            };
            veronese::segment_pair(&data.first, &data.second, None, &options, &mut |s: veronese::Stage| {
                add(s.name.to_owned(), &mut sums)
            })
            .unwrap();
            add("end".into(), &mut sums);
        }
        for (k, v) in sums {
            println!("{:6.1} {k}", v / cases.len() as f64);
        }
        return;
    }
    let names: Vec<String> =
        cases.iter().filter(|c| c.set == Set::Sequences).map(|c| c.sequence().to_owned()).collect();
    let mut seqs = names.clone();
    seqs.sort();
    seqs.dedup();
    let method = if fast { Method::Fast } else { Method::Best };
    let found = in_parallel(&cases, |c| {
        let data = c.load().map_err(|e| e.to_string())?;
        Ok(of_variant(Variant::Whole, method, &data)?)
    })
    .unwrap();
    let mut rows: BTreeMap<String, Vec<(f64, f64, f64, f64)>> = BTreeMap::new();
    for (c, o) in cases.iter().zip(&found) {
        let (Some(s), Some(g)) = (o.single.as_ref(), o.grouped.as_ref()) else { continue };
        let row = match c.set {
            Set::Sequences => {
                let k = seqs.iter().position(|s| s == c.sequence()).unwrap();
                if k % 2 == 0 { "1 fold A" } else { "2 fold B" }
            }
            Set::Pairs => "3 pairs",
            Set::Bare => {
                if c.name.contains("-46") {
                    "6 bare"
                } else {
                    "7 bare new"
                }
            }
            Set::SharedScenes => "8 shared scenes",
            Set::Robots => "9 robots",
            Set::Large => "91 large",
            _ => {
                if c.name.contains("-5") && (c.name.split('-').last().unwrap().parse::<u64>().unwrap() >= 50_000) {
                    "5 scenes new"
                } else {
                    "4 scenes"
                }
            }
        };
        let v = if c.set.is_scene() {
            (s.miou, f64::from(u8::from(s.found_count == s.truth_count)), s.boundary.unwrap_or(0.0), o.milliseconds)
        } else {
            (g.j_background.unwrap_or(0.0), s.j_oracle.unwrap_or(0.0), g.boundary.unwrap_or(0.0), o.milliseconds)
        };
        if each {
            println!("{:28} {:.3} {:.3} {:.3} n{} {:.0}", c.name, v.0, v.1, v.2, s.found_count, v.3);
        }
        rows.entry(row.into()).or_default().push(v);
        if c.set == Set::Sequences {
            rows.entry("0 all pairs".into()).or_default().push(v);
        }
    }
    let mut line = String::new();
    for (name, v) in &rows {
        let n = v.len() as f64;
        let m = |f: &dyn Fn(&(f64, f64, f64, f64)) -> f64| v.iter().map(f).sum::<f64>() / n;
        println!(
            "{name:16} {:4} {:.3} {:.3} {:.3} {:6.0} ms",
            v.len(),
            m(&|v| v.0),
            m(&|v| v.1),
            m(&|v| v.2),
            m(&|v| v.3)
        );
    }
}
