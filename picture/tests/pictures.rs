//! What is drawn of missions and executions: the examples as snapshots, and what holds of all pictures.

#![allow(clippy::unwrap_used, reason = "a test that fails may panic")]
#![allow(clippy::disallowed_methods, reason = "the examples are files")]

use std::fs;
use std::path::{Path, PathBuf};

use kirk_compiler::{Compilation, Options, Source, compile};
use kirk_network::generate::{LaneOptions, lanes};
use kirk_network::rmpl;
use kirk_picture::{Chart, Look, Scene, Shape, html, mermaid, svg};
use kirk_runtime::{Plan, Simulation, Temper, simulate};
use kirk_team::record::Record;

fn missions() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/rmpl");
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "rmpl"));
    files.sort();
    files
}

fn compiled(text: &str) -> Compilation {
    compile(&[Source::new("test.rmpl", text)], &Options::default())
}

fn chart(text: &str) -> Chart {
    let compilation = compiled(text);
    Chart::of_mission("main", &compilation.episodes.unwrap(), &compilation.lowered.unwrap().network)
}

/// A mission as it is planned, and as it goes if Nature takes some time.
fn both(text: &str, seed: u64) -> Vec<Chart> {
    let compilation = compiled(text);
    let network = compilation.lowered.unwrap().network;
    let planned = Chart::of_mission("main", &compilation.episodes.unwrap(), &network);
    let Ok(plan) = Plan::new(&network) else { return vec![planned] };
    let simulation = Simulation { nature: Temper::Random, seed, internal: true, ..Simulation::default() };
    let execution = simulate(&plan, "main", &simulation).unwrap();
    let executed = planned.clone().executed(&execution);
    vec![planned, executed, Chart::of_execution(&execution)]
}

/// A scene, line by line.
fn told(scene: &Scene) -> String {
    let mut told = format!("{} x {}: {}: {}\n", scene.width, scene.height, scene.title, scene.says);
    for item in &scene.items {
        let points =
            |points: &[f64]| points.iter().map(|it| format!("{it:.0}")).collect::<Vec<_>>().join(" ");
        let shape = match &item.shape {
            Shape::Box(at) => format!("box {}", points(at)),
            Shape::Line(at) => format!("line {}", points(at)),
            Shape::Arrow(at) => format!("arrow {}", points(at)),
            Shape::Diamond(at) => format!("diamond {}", points(at)),
            Shape::Words { at, text, .. } => format!("{text:?} {}", points(at)),
        };
        let of = item.of.map_or(String::new(), |of| format!(" of {}", scene.bars[of].0));
        told.push_str(&format!("  {}: {shape}{of}\n", item.class));
    }
    for (_, hint) in &scene.bars {
        told.push_str(&format!("{hint}\n"));
    }
    told
}

#[test]
fn every_example_has_its_picture() {
    for file in missions() {
        let name = file.file_stem().unwrap().to_str().unwrap().to_string();
        let text = fs::read_to_string(&file).unwrap();
        if compiled(&text).lowered.is_none() {
            continue;
        }
        insta::assert_snapshot!(name.clone(), told(&Scene::new(&chart(&text), Look::default())));
    }
}

#[test]
fn an_execution_shows_what_happened_and_when_it_was_heard() {
    let text = fs::read_to_string("../examples/rmpl/robot.rmpl").unwrap();
    let executed = both(&text, 7).remove(1);
    insta::assert_snapshot!(told(&Scene::new(&executed, Look::default())));
}

fn overlapping(scene: &Scene) -> Option<(String, String)> {
    let words = scene.words();
    for (index, ([x, y, w, h], one)) in words.iter().enumerate() {
        for ([x2, y2, w2, h2], other) in &words[..index] {
            if x < &(x2 + w2) && x2 < &(x + w) && y < &(y2 + h2) && y2 < &(y + h) {
                return Some((one.to_string(), other.to_string()));
            }
        }
    }
    None
}

/// Random missions of parallel lanes, as programs.
fn random_mission(seed: u64) -> String {
    let options = LaneOptions { delay: 30, links: 40, ..LaneOptions::default() };
    rmpl::write(&lanes(1 + seed as u32 % 8, 1 + seed as u32 % 20, seed, &options).unwrap())
}

#[test]
fn no_words_overlap_and_all_is_inside() {
    let mut missions: Vec<String> = missions()
        .iter()
        .map(|file| fs::read_to_string(file).unwrap())
        .filter(|text| compiled(text).lowered.is_some())
        .collect();
    missions.extend((0..300).map(random_mission));
    for (seed, text) in missions.iter().enumerate() {
        for chart in both(text, seed as u64) {
            let scene = Scene::new(&chart, Look::default());
            assert_eq!(overlapping(&scene), None, "{seed}: {text}");
            for item in &scene.items {
                let inside =
                    |x: f64, y: f64| (0.0..=scene.width).contains(&x) && (0.0..=scene.height).contains(&y);
                let is_inside = match &item.shape {
                    Shape::Box([x, y, w, h]) => inside(*x, *y) && inside(x + w, y + h) && *w > 0.0,
                    Shape::Line([x, y, x2, y2]) | Shape::Arrow([x, y, x2, y2]) => {
                        inside(*x, *y) && inside(*x2, *y2)
                    }
                    Shape::Diamond([x, y]) | Shape::Words { at: [x, y], .. } => inside(*x, *y),
                };
                assert!(is_inside, "{seed}: {item:?}\n{text}");
            }
        }
    }
}

#[test]
fn strange_names_are_xml_all_the_same() {
    let text = r#"{"format": "kirk-network/1", "origin": "z", "events": ["z", "a<b&\"'\u0007:start", "a<b&\"'\u0007:end"],
        "requirements": [{"from": "z", "to": "a<b&\"'\u0007:start", "upper": 3}],
        "contingents": [{"from": "a<b&\"'\u0007:start", "to": "a<b&\"'\u0007:end", "lower": 1, "upper": 2}]}"#;
    let network = kirk_network::json::read(text).unwrap();
    let text = svg(&Scene::new(&Chart::of_network("<&>", &network), Look::default()));
    let mut reader = quick_xml::Reader::from_str(&text);
    while !matches!(reader.read_event().unwrap(), quick_xml::events::Event::Eof) {}
    assert!(text.contains("a&lt;b&amp;&quot;") && text.contains("&lt;&amp;&gt;"), "{text}");
}

#[test]
fn a_page_fetches_nothing() {
    let text = fs::read_to_string("../examples/rmpl/sampling-eva.rmpl").unwrap();
    let page = html(&Scene::new(&both(&text, 1).remove(1), Look::default()));
    for fetched in ["src=", "href=", "@import", "fetch(", "import("] {
        assert!(!page.contains(fetched), "{fetched}");
    }
    let addresses = page.matches("http").count();
    assert_eq!(addresses, page.matches("http://www.w3.org/2000/svg").count(), "{page}");
    assert!(page.contains("data-known=") && !page.contains("{{"));
}

#[test]
fn a_large_mission_is_a_page_below_a_megabyte() {
    let network = lanes(20, 100, 1, &LaneOptions::default()).unwrap();
    let page = html(&Scene::new(&Chart::of_network("large", &network), Look::default()));
    assert!(page.len() < 1_000_000, "{}", page.len());
}

#[test]
fn a_gantt_chart_of_mermaid_names_every_activity() {
    insta::assert_snapshot!(mermaid(&chart(
        &fs::read_to_string("../examples/rmpl/sampling-eva.rmpl").unwrap()
    )));
}

#[test]
fn a_team_has_a_lane_for_each_agent_and_news_between_them() {
    let record: Record = kirk_network::json::parse(include_str!("team.json")).unwrap();
    let scene = Scene::new(&Chart::of_team(&record), Look::default());
    assert_eq!(overlapping(&scene), None);
    insta::assert_snapshot!(told(&scene));
}
