//! GraphML of the CSTNU Tool and plain text: the samples read as their JSON does, what is written reads back equal, and
//! broken files get messages that name the place.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "a test may fail, and reads its samples")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use insta::assert_snapshot;
use kirk_network::graphml::WriteError;
use kirk_network::json::ReadProblem;
use kirk_network::precedence::Precedence;
use kirk_network::{
    Bound, ContingentLink, Delay, Duration, Event, EventId, Name, Network, Requirement, dispatchable, dot,
    graphml, json, plain, reduce,
};
use oracle::random::Random;

mod oracle;

fn sample(file: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/networks").join(file);
    fs::read_to_string(path).unwrap()
}

/// What a network says, whatever the order: names of events, the tightest edges, links.
type Meaning = (
    BTreeSet<String>,
    BTreeSet<Vec<String>>,
    BTreeMap<(String, String), i64>,
    BTreeSet<(String, String, i64, i64, String)>,
);

fn meaning(network: &Network) -> Meaning {
    let names = |event: &Event| event.names.iter().map(|name| name.text.clone()).collect::<Vec<_>>();
    let id = |event: EventId| network.id(event).to_string();
    let origin = names(&network.events()[network.origin().index()]);
    let mut edges = BTreeMap::new();
    let mut edge = |from, to, weight: i64| {
        let known = edges.entry((id(from), id(to))).or_insert(weight);
        *known = weight.min(*known);
    };
    for requirement in network.requirements() {
        if let Bound::Finite(upper) = requirement.upper {
            edge(requirement.from, requirement.to, upper.as_micros());
        }
        if let Bound::Finite(lower) = requirement.lower {
            edge(requirement.to, requirement.from, -lower.as_micros());
        }
    }
    let links = network.contingents().iter().map(|link| {
        let delay = format!("{:?}", link.delay);
        (id(link.from), id(link.to), link.lower.as_micros(), link.upper.as_micros(), delay)
    });
    let events = network.events().iter().map(names).collect();
    (origin.into_iter().collect(), events, edges, links.collect())
}

/// The problems with the line, column and text they point at.
fn show(text: &str, problems: &[ReadProblem]) -> String {
    let line = |problem: &ReadProblem| {
        let before = &text[..problem.offset];
        let column = before.chars().rev().take_while(|&char| char != '\n').count() + 1;
        format!("{}:{column} {}\n", before.matches('\n').count() + 1, problem.message)
    };
    problems.iter().map(line).collect()
}

#[test]
fn the_samples_read_as_their_json_does() {
    for name in ["lane50_dc_000", "lane50_notDC_000", "lane500_dc_000"] {
        let known = json::read(&sample(&format!("{name}.json"))).unwrap();
        let read = graphml::read(&sample(&format!("{name}.stnu"))).unwrap();
        assert_eq!(meaning(&read), meaning(&known), "{name}");
        // More than brief: the same requirements in the same order and direction.
        assert_eq!(read.requirements(), known.requirements(), "{name}");
        assert_eq!(read.contingents(), known.contingents(), "{name}");
        assert_eq!(read.events(), known.events(), "{name}");
    }
    let known = json::read(&sample("lane50_dc_000.json")).unwrap();
    let read = plain::read(&sample("lane50_dc_000.plainstnu")).unwrap();
    assert_eq!(read.requirements(), known.requirements());
    assert_eq!(meaning(&read), meaning(&known));
}

#[test]
fn both_ways_to_write_a_contingent_link_are_read() {
    let file = |forward: &str, back: &str| {
        format!(
            "<graphml><graph><node id='Z'/><node id='A'/><node id='C'/>\
             <edge id='f' source='A' target='C'><data key='Type'>contingent</data>{forward}</edge>\
             <edge id='b' source='C' target='A'><data key='Type'>contingent</data>{back}</edge></graph></graphml>"
        )
    };
    let labelled =
        file("<data key='LabeledValue'>LC(C):1.5</data>", "<data key='LabeledValue'>UC(C):-4</data>");
    let valued = file("<data key='Value'>4</data>", "<data key='Value'>-1.5</data>");
    let both = file(
        "<data key='Value'>4</data><data key='LabeledValue'>LC(C):1.5</data>",
        "<data key='Value'>-1.5</data><data key='LabeledValue'>UC(C):-4</data>",
    );
    let (labelled, valued, both) =
        (graphml::read(&labelled).unwrap(), graphml::read(&valued).unwrap(), graphml::read(&both).unwrap());
    assert_eq!(labelled, valued);
    assert_eq!(labelled.contingents(), both.contingents());
    assert_eq!(both.requirements().len(), 1, "values beside labels are a requirement of their own");
    let link = labelled.contingents()[0];
    assert_eq!((labelled.id(link.from), labelled.id(link.to)), ("A", "C"));
    assert_eq!((link.lower, link.upper), (Duration::from_micros(1_500_000), Duration::from_secs(4)));
}

/// A network with no delays, odd names, merged and internal ones too; at times several requirements between two events.
fn random_network(random: &mut Random, parallel: bool) -> Network {
    let odd = [
        "Z",
        "a b",
        "<&>\"'",
        "x\ty\nz\r",
        "ü→\u{1F600}",
        "\u{1}\u{ffff}",
        "e_Z",
        "A_B",
        "]]>",
        "node2",
        "'quoted'",
        "\"\"",
        "",
        " ",
    ];
    let count = random.within(2..=12) as u32;
    let mut names: Vec<String> = (0..count).map(|n| format!("event.{n}")).collect();
    for odd in odd {
        if random.percent(20) {
            names.push(odd.to_string());
        }
    }
    random.shuffle(&mut names);
    let mut events: Vec<Vec<Name>> = Vec::new();
    for text in names {
        let name = Name { text, internal: random.percent(30) };
        match events.last_mut() {
            Some(event) if random.percent(20) => event.push(name),
            _ => events.push(vec![name]),
        }
    }
    let events: Vec<Event> = events.into_iter().map(|names| Event { names: names.into() }).collect();
    let count = events.len() as i64;
    let origin = EventId(random.within(0..=count - 1) as u32);
    let micros = |random: &mut Random, range| Duration::from_micros(random.within(range));
    let mut contingents = Vec::new();
    // Each event after the first ends a link from an earlier one, at times.
    for to in 1..count as u32 {
        if EventId(to) != origin && random.percent(30) {
            let lower = micros(random, 0..=5_000_000);
            let upper = lower.checked_add(micros(random, 0..=5_000_000)).unwrap();
            let from = EventId(random.within(0..=i64::from(to) - 1) as u32);
            contingents.push(ContingentLink { from, to: EventId(to), lower, upper, delay: Delay::NONE });
        }
    }
    let mut requirements: Vec<Requirement> = Vec::new();
    for _ in 0..random.within(0..=2 * count) {
        let (from, to) =
            (EventId(random.within(0..=count - 1) as u32), EventId(random.within(0..=count - 1) as u32));
        let taken = requirements.iter().any(|r| (r.from, r.to) == (from, to) || (r.from, r.to) == (to, from));
        if !parallel && (taken || from == to) {
            continue;
        }
        let upper = micros(random, -9_000_000..=9_000_000);
        let lower = upper.checked_sub(micros(random, 0..=9_000_000)).unwrap();
        let lower = if random.percent(40) { Bound::Infinite } else { Bound::Finite(lower) };
        let upper = if random.percent(30) { Bound::Infinite } else { Bound::Finite(upper) };
        requirements.push(Requirement { from, to, lower, upper });
    }
    Network::new("r<a>n".to_string(), origin, events, requirements, contingents).unwrap()
}

#[test]
fn what_is_written_reads_back_equal() {
    let mut random = Random::new(3);
    for round in 0..4000 {
        let network = random_network(&mut random, round % 2 == 0);
        let text = graphml::write(&network).unwrap();
        let back = graphml::read(&text).unwrap_or_else(|problems| panic!("{}{text}", show(&text, &problems)));
        assert_eq!(back, network, "round {round}\n{text}");
    }
}

#[test]
fn without_our_own_data_the_edges_say_the_same() {
    let mut random = Random::new(4);
    for round in 0..2000 {
        let network = random_network(&mut random, true);
        let text = graphml::write(&network).unwrap();
        let plain: Vec<&str> = text.lines().filter(|line| !line.contains("key=\"Requirements\"")).collect();
        let back = graphml::read(&plain.join("\n")).unwrap();
        assert_eq!(meaning(&back), meaning(&network), "round {round}\n{text}");
    }
}

#[test]
fn once_an_edge_is_changed_the_list_of_requirements_counts_no_more() {
    let text = r#"{"format": "kirk-network/1", "origin": "Z", "events": ["Z", "A"],
        "requirements": [{"from": "Z", "to": "A", "upper": 7}, {"from": "Z", "to": "A", "lower": 2}]}"#;
    let network = json::read(text).unwrap();
    let written = graphml::write(&network).unwrap();
    assert_eq!(graphml::read(&written).unwrap(), network);
    let changed = written.replace("<data key=\"Value\">7</data>", "<data key=\"Value\">8</data>");
    assert_ne!(changed, written);
    let bounds = |text: &str| match graphml::read(text).unwrap().requirements() {
        [one] => (one.lower, one.upper),
        several => panic!("{several:?}"),
    };
    let seconds = |seconds| Bound::Finite(Duration::from_secs(seconds));
    assert_eq!(bounds(&changed), (seconds(2), seconds(8)));
}

#[test]
fn damage_to_our_own_data_is_a_problem() {
    let file = |graph: &str, node: &str| {
        format!(
            "<graphml><graph><data key='Requirements'>{graph}</data><node id='Z'/><node id='A'><data key='Internal'>{node}</data></node></graph></graphml>"
        )
    };
    let all = [file("[[1]]", "7"), file("[[\"Z\", \"A\", \"x\", null]]", "[\"B\"]")];
    let shown: Vec<String> = all.iter().map(|text| broken_graphml(text)).collect();
    assert_snapshot!(shown.join("-\n"), @r#"
    1:42 `Requirements` must be a JSON list of rows, like [["Z", "A", "1.5", null]]
    1:102 node `A`: `Internal` must be a JSON list of names, like ["a", "b"]
    -
    1:42 `Requirements`: the bound `x`: this is not a number of seconds
    1:120 node `A`: `Internal` has `B`, which is none of its names
    "#);
}

#[test]
fn contradicting_edges_are_read_and_left_to_the_check() {
    let text = "# Time-Point Names\nZ A\n# Ordinary Edges\nZ 3 A\nA -5 Z\n";
    let network = plain::read(text).unwrap();
    assert_eq!(network.requirements().len(), 2);
    assert!(matches!(kirk_network::check(&network), Ok(kirk_network::Verdict::Uncontrollable(_))));
    assert_eq!(meaning(&graphml::read(&graphml::write(&network).unwrap()).unwrap()), meaning(&network));
}

fn delayed() -> Network {
    let text = r#"{"format": "kirk-network/1", "origin": "start", "events": ["start", {"id": "a", "names": ["a", "b \"&\\ <i>"]}, "c"],
        "requirements": [{"from": "start", "to": "a", "upper": 5}, {"from": "c", "to": "start"}],
        "contingents": [{"from": "start", "to": "c", "lower": 1, "upper": 2.5, "delay": [0, null]}]}"#;
    json::read(text).unwrap()
}

#[test]
fn delays_cannot_be_written() {
    let errors = graphml::write(&delayed()).unwrap_err();
    assert_eq!(errors, [WriteError::Delay { from: "start".to_string(), to: "c".to_string() }]);
    assert_snapshot!(errors[0], @r#"the contingent link from `start` to `c` has an observation delay, which the CSTNU Tool format cannot express; write the reduced network instead"#);
}

fn graph(elements: &str) -> String {
    format!(
        "<graphml>\n<graph>\n<node id=\"Z\"/><node id=\"A\"/><node id=\"C\"/>\n{elements}\n</graph>\n</graphml>\n"
    )
}

fn edge(id: &str, source: &str, target: &str, data: &str) -> String {
    let data: String = data
        .split(' ')
        .filter(|data| !data.is_empty())
        .map(|data| {
            let (key, value) = data.split_once('=').unwrap();
            format!("<data key=\"{key}\">{value}</data>")
        })
        .collect();
    format!("<edge id=\"{id}\" source=\"{source}\" target=\"{target}\">{data}</edge>\n")
}

fn broken_graphml(text: &str) -> String {
    match graphml::read(text) {
        Ok(_) => panic!("this should not be read:\n{text}"),
        Err(problems) => show(text, &problems),
    }
}

#[test]
fn broken_edges_get_a_message_each() {
    let edges = [
        edge("e1", "A", "C", "Value=1.0000001"),
        edge("e2", "A", "Q", "Value=x"),
        edge("e3", "A", "C", "Type=wish Value=3"),
        edge("e3", "A", "C", "Value=3 Value=4"),
        edge("e4", "A", "C", "LabeledValue=UC(C):-3"),
        edge("e5", "A", "C", "LowerCaseLabeledValues={(C,2,⊡)}"),
        "<edge source=\"A\"/>\n".to_string(),
        "<hyperedge/>\n".to_string(),
        "<node id=\"A\"/><node/><node id=\"O\"><data key=\"Obs\">p</data></node>\n".to_string(),
        "<node id=\"N\"><data key=\"Names\">[\"Z\"]</data></node><node id=\"M\"><data key=\"Names\">x</data></node>\n"
            .to_string(),
    ];
    assert_snapshot!(broken_graphml(&graph(&edges.concat())), @r#"
    4:55 edge `e1`: the value `1.0000001`: this has digits below a microsecond (kirk never rounds a bound)
    5:1 edge `e2`: its target, the node `Q`, does not exist
    5:55 edge `e2`: the value `x`: this is not a number of seconds
    6:54 edge `e3`: expected the type `requirement` or `contingent`, not `wish`
    7:1 edge `e3`: there is another edge with this id
    7:81 edge `e3`: it has `Value` twice
    8:62 edge `e4`: only a contingent edge has a `LabeledValue`; waits belong to dispatchable networks, which are not read
    9:72 edge `e5`: `LowerCaseLabeledValues` belongs to conditional networks, which are not read
    10:1 edge `A` -> `?` has no `target`
    11:1 `<hyperedge>` is not understood here
    12:1 node `A`: there is another node with this id
    12:15 a node has no `id`
    12:51 node `O` has the observation `p`: conditional networks (CSTN, CSTNU) are not read
    13:1 node `N`: the name `Z` is used already (case does not count)
    13:82 node `M`: `Names` must be a JSON list of names, like ["a", "b"]
    "#);
}

#[test]
fn broken_contingent_links_get_a_message_each() {
    let pair = |forward: &str, back: &str| {
        let contingent = |data: &str| format!("Type=contingent {data}");
        let edges = edge("f", "A", "C", &contingent(forward)) + &edge("b", "C", "A", &contingent(back));
        broken_graphml(&graph(&edges))
    };
    let all = [
        pair("", ""),
        pair("Value=4", ""),
        pair("Value=4", "Value=2"),
        pair("Value=0", "Value=0"),
        pair("Value=4", "Value=z"),
        pair("LabeledValue=LC(C):1", ""),
        pair("LabeledValue=LC(C):1", "Value=-3"),
        pair("LabeledValue=LC(C):1", "LabeledValue=LC(C):3"),
        pair("LabeledValue=LC(A):1", "LabeledValue=UC(C):-3"),
        pair("LabeledValue=LC(Q):1", "LabeledValue=UC(C:-3"),
        pair("LabeledValue=LC(C):5", "LabeledValue=UC(C):-3"),
        pair("LabeledValue=LC(C):-1", "LabeledValue=UC(C):-3"),
        broken_graphml(&graph(&edge("f", "A", "C", "Type=contingent Value=4"))),
        broken_graphml(&graph(&edge("loop", "A", "A", "Type=contingent Value=4"))),
        broken_graphml(&graph(
            &(edge("f", "A", "Z", "Type=contingent Value=4")
                + &edge("b", "Z", "A", "Type=contingent Value=-4")),
        )),
        broken_graphml(&graph(
            &(edge("f", "A", "C", "Type=contingent Value=4")
                + &edge("b", "C", "A", "Type=contingent Value=-4")
                + &edge("g", "Z", "C", "Type=contingent Value=4")
                + &edge("c", "C", "Z", "Type=contingent Value=-4")
                + &edge("h", "A", "C", "Type=contingent Value=5")),
        )),
        broken_graphml(&graph(
            &(edge("g", "Z", "C", "Type=contingent Value=4")
                + &edge("c", "C", "Z", "Type=contingent Value=-4")
                + &edge("f", "A", "C", "Type=contingent Value=4")
                + &edge("b", "C", "A", "Type=contingent Value=-4")),
        )),
    ];
    assert_snapshot!(all.join("-\n"), @r"
    4:1 edge `f`: expected a `LabeledValue` (`LC(C):lower` towards the contingent event C, `UC(C):-upper` away from it) or a `Value` (`upper` towards, `-lower` away)
    -
    5:1 edge `b`: expected a `LabeledValue` (`LC(C):lower` towards the contingent event C, `UC(C):-upper` away from it) or a `Value` (`upper` towards, `-lower` away)
    -
    4:1 edge `f` and edge `b`: their values 4 and 2 do not say which end is contingent; one must be the upper bound, above 0, the other the lower bound with a minus sign
    -
    4:1 edge `f` and edge `b`: their values 0 and 0 do not say which end is contingent; one must be the upper bound, above 0, the other the lower bound with a minus sign
    -
    5:88 edge `b`: the value `z`: this is not a number of seconds
    -
    5:1 edge `b`: the edge back has a `LabeledValue`, so this one needs one as well
    -
    5:1 edge `b`: the edge back has a `LabeledValue`, so this one needs one as well
    -
    4:1 edge `f` and edge `b`: expected `LC(C):lower` from `A` to `C` and `UC(C):-upper` back, with the event the edges lead to and from
    -
    4:1 edge `f` and edge `b`: expected `LC(C):lower` from `A` to `C` and `UC(C):-upper` back, with the event the edges lead to and from
    -
    4:95 edge `f`: there is no node `Q`, which `LC(Q):1` names
    5:95 edge `b`: expected `LC(C):lower` or `UC(C):-upper`, not `UC(C:-3`
    -
    4:1 edge `f`: the lower bound 5 is above the upper bound 3: Nature has no duration to choose from. Only what is required may contradict itself: two requirements in `.json`, two ordinary edges in `.stnu` and `.plainstnu`
    -
    4:1 edge `f`: the bounds [-1, 3] are not 0 <= lower <= upper; Nature needs a duration to choose from
    -
    4:1 edge `f`: a contingent link is a pair of edges; there is no contingent edge from `C` back to `A`
    -
    4:1 edge `loop`: a contingent link is a pair of edges; there is no contingent edge from `A` back to `A`
    -
    4:1 edge `f`: the link ends in the origin, which is executed first
    -
    8:1 edge `h`: there is another contingent edge from `A` to `C`
    -
    6:1 edge `f`: `C` already ends another contingent link; an event happens once
    ");
}

#[test]
fn broken_files_get_a_message() {
    let all = [
        "",
        "{\"format\": 1}",
        "<svg></svg>",
        "<graphml/>",
        "<graphml><graph>",
        "<graphml><graph></graphml>",
        "<graphml><graph/></graphml>",
        "<graphml><graph/></graphml><graphml/>",
        "<graphml><graph><node id='Z'/>hello</graph></graphml> trailing",
        "<graphml><graph><data key='NetworkType'>CSTNU</data><node id='Z'/></graph></graphml>",
        "<graphml><graph><node id='Z' id='Y'/></graph></graphml>",
        "<graphml><graph><node id='&boom;'/></graph></graphml>",
        "<!DOCTYPE g [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]><graphml><graph><node id='Z'/><data key='Name'>&b;&#0;</data></graph></graphml>",
        "<graphml><graph><node id='Z'/><graph/></graph><graph/></graphml>",
        "\u{feff}<graphml><graph><node id='ü'/></graph></graphml>",
        "<graphml><graph><!-- <node id='Z'/>",
        "<graphml><graph><node id='Z></graph></graphml>",
    ];
    let shown: Vec<String> = all.iter().map(|text| broken_graphml(text)).collect();
    assert_snapshot!(shown.join("-\n"), @r"
    1:1 expected a GraphML file, with `<graphml>` as its outermost element
    -
    1:1 expected a GraphML file, with `<graphml>` as its outermost element
    -
    1:1 expected a GraphML file, with `<graphml>` as its outermost element, not `<svg>`
    -
    1:11 there is no `<graph>` in `<graphml>`
    -
    1:17 the file ends in the middle: expected `</graphml>`
    -
    1:17 this is not XML: ill-formed document: expected `</graph>`, but `</graphml>` was found
    -
    1:10 there is no node `Z`: the origin, executed first at time 0, is the node with that id
    -
    1:28 expected a GraphML file, with `<graphml>` as its outermost element, not `<graphml>`
    -
    1:31 unexpected text `hello`
    1:54 unexpected text `trailing`
    -
    1:41 the network type is `CSTNU`, a conditional network with uncertainty (what must hold depends on what is observed); this kirk reads `STNU` and `STN`
    -
    1:10 there is no node `Z`: the origin, executed first at time 0, is the node with that id
    1:17 `<node>`: it has `id` twice
    -
    1:10 there is no node `Z`: the origin, executed first at time 0, is the node with that id
    1:17 `<node>`: its `id` cannot be read: at 1..5: unrecognized entity `boom`
    1:17 a node has no `id`
    -
    1:101 the entity `&b;` is not one of XML itself
    1:104 the entity `&#0;` is not one of XML itself
    -
    1:31 `<graph>` is not understood here
    1:47 `<graph>` is not understood here
    -
    1:11 there is no node `Z`: the origin, executed first at time 0, is the node with that id
    -
    1:17 this is not XML: syntax error: comment not closed: `-->` not found before end of input
    -
    1:17 this is not XML: syntax error: attribute value not closed: `'` not found before end of input
    ");
}

#[test]
fn xml_that_is_unusual_is_read() {
    let text = "\u{feff}<?xml version='1.0'?>\r\n<!DOCTYPE graphml>\r\n<g:graphml xmlns:g='x'><!-- c -->\r\n\
        <g:key id='d0' for='edge' attr.name='Value'><g:default>7</g:default></g:key><g:desc>about</g:desc>\r\n\
        <g:graph><g:data key='Name'>a &lt;&#33;<![CDATA[<b>]]></g:data>\r\n\
        <g:node id='Z'><g:data key='x'><y:Shape xmlns:y='y'>red</y:Shape></g:data></g:node><g:node id='A&#65;'/>\r\n\
        <g:edge source='Z' target='AA'/><g:edge source='AA' target='Z'><g:data key='d0'> -2 </g:data></g:edge>\r\n\
        </g:graph></g:graphml>\r\n";
    let network = graphml::read(text).unwrap_or_else(|problems| panic!("{}", show(text, &problems)));
    assert_eq!(network.name(), "a <!<b>");
    let requirement = network.requirements()[0];
    assert_eq!(network.id(requirement.to), "AA");
    assert_eq!(requirement.lower, Bound::Finite(Duration::from_secs(2)));
    assert_eq!(requirement.upper, Bound::Finite(Duration::from_secs(7)));
}

#[test]
fn no_damage_to_a_file_makes_a_reader_panic() {
    let mut random = Random::new(5);
    let (xml, text) = (sample("lane50_dc_000.stnu"), sample("lane50_dc_000.plainstnu"));
    for _ in 0..3000 {
        for (whole, graph) in [(&xml, true), (&text, false)] {
            let mut bytes: Vec<u8> = whole.as_bytes().to_vec();
            for _ in 0..random.within(1..=4) {
                let at = random.within(0..=bytes.len() as i64 - 1) as usize;
                match random.within(0..=3) {
                    0 => bytes.truncate(at + 1),
                    1 => drop(bytes.remove(at)),
                    2 => bytes[at] = *random.choose(b"<>&\"'/ =-#\nZ9\xc3"),
                    _ => bytes.insert(at, *random.choose(b"<>&;\"'/ =-#\nA0]!")),
                }
                if bytes.is_empty() {
                    bytes.push(b'x');
                }
            }
            let damaged = String::from_utf8_lossy(&bytes);
            let read = if graph { graphml::read(&damaged) } else { plain::read(&damaged) };
            if let Err(problems) = read {
                assert!(!problems.is_empty());
                show(&damaged, &problems);
            }
        }
    }
}

#[test]
fn deep_and_wide_xml_is_harmless() {
    let deep = format!("<graphml><graph>{}", "<a>".repeat(200_000));
    assert!(graphml::read(&deep).is_err());
    // What is done for each of many must not be compared with each other.
    let many = |text: &dyn Fn(usize) -> String| (0..100_000).map(text).collect::<String>();
    let wide = many(&|n| format!(" a{n}='&lt;'"));
    graphml::read(&format!("<graphml><graph><node id='Z'{wide}/></graph></graphml>")).unwrap();
    let data = many(&|n| format!("<data key='k{n}'/>"));
    graphml::read(&format!("<graphml><graph><node id='Z'>{data}</node></graph></graphml>")).unwrap();
    let edges = "Z 1 A\n".repeat(100_000) + &"A -5 Z\n".repeat(100_000);
    let network = plain::read(&format!("# Time-Point Names\nZ A\n# Ordinary Edges\n{edges}")).unwrap();
    assert_eq!(network.requirements().len(), 200_000);
    graphml::read(&graphml::write(&network).unwrap()).unwrap();
}

#[test]
fn plain_text_may_have_blank_lines_comments_and_carriage_returns() {
    let text = "\u{feff}# a comment\r\n\r\n# KIND OF NETWORK\r\nSTNU\r\n#Num Time-Points\r\n3\r\n# Time-Point  names\r\nZ A\r\n\r\n C\r\n\
        # ORDINARY EDGES\r\n# the deadline\r\n C  10.5\tZ \r\nZ 1e1 C\r\n# Contingent Links\r\nA 4 6 C";
    let network = plain::read(text).unwrap_or_else(|problems| panic!("{}", show(text, &problems)));
    assert_eq!(network.events().len(), 3);
    let requirement = network.requirements()[0];
    assert_eq!(requirement.upper, Bound::Finite(Duration::from_micros(10_500_000)));
    assert_eq!(requirement.lower, Bound::Finite(Duration::from_secs(-10)));
    assert_eq!(network.contingents()[0].upper, Duration::from_secs(6));
}

#[test]
fn names_in_quotes_are_the_names_without_them() {
    let sample_text = sample("lane50_dc_000.plainstnu");
    let quoted: String = sample_text
        .lines()
        .map(|line| {
            let name = |word: &str| match word.parse::<i64>() {
                Ok(_) => word.to_string(),
                Err(_) => format!("\"{word}\""),
            };
            let words = || line.split(' ').map(name).collect::<Vec<_>>().join(" ");
            let plain = line.starts_with('#') || line == "STNU";
            (if plain { line.to_string() } else { words() }) + "\n"
        })
        .collect();
    assert!(quoted.contains("\"A1\" 4 6 \"C1\""), "the links of the sample are quoted");
    assert_eq!(plain::read(&quoted).unwrap(), plain::read(&sample_text).unwrap());
    let text = "# KIND OF NETWORK\n\"STNU\"\n# Time-Point Names\n'Z' \"the door\" 'it''s open' isn't\n# Ordinary Edges\n\
                \"the door\" 10 'it''s open'\nZ 4 isn't\n";
    let read = plain::read(text).unwrap_or_else(|problems| panic!("{}", show(text, &problems)));
    let names: Vec<&str> = read.event_ids().map(|event| read.id(event)).collect();
    assert_eq!(names, ["Z", "the door", "it''s open", "isn't"]);
    // A place is where the text stands, quotes and all.
    let (_, places) = plain::read_with_source_map(text).unwrap();
    assert_eq!(&text[places.requirements[0][0].clone()], "\"the door\" 10 'it''s open'");

    let xml = sample("lane50_dc_000.stnu");
    let escaped = xml.replace("LC(", "LC(&quot;").replace("UC(", "UC(&quot;").replace("):", "&quot;):");
    assert!(escaped.contains("LC(&quot;C1&quot;):4"));
    assert_eq!(graphml::read(&escaped).unwrap(), graphml::read(&xml).unwrap());
    let small = |quote: &str| {
        let name = |name: &str| format!("'{quote}{name}{quote}'");
        let (z, a, c) = (name("Z"), name("A"), name("C"));
        format!(
            "<graphml><graph><node id={z}/><node id={a}/><node id={c}/>\
             <edge source={a} target={c}><data key='Type'>contingent</data><data key='Value'>4</data></edge>\
             <edge source={c} target={a}><data key='Type'>contingent</data><data key='Value'>-1</data></edge>\
             <edge source={z} target={a}><data key='Value'>9</data></edge></graph></graphml>"
        )
    };
    assert_eq!(graphml::read(&small("&quot;")).unwrap(), graphml::read(&small("")).unwrap());
}

#[test]
fn broken_quotes_get_a_message() {
    let text = "# Time-Point Names\nZ \"A b\" ''\n# Ordinary Edges\n\"A b 10 Z\nA 10 'Z'\n";
    let problems = plain::read(text).unwrap_err();
    assert_snapshot!(show(text, &problems), @r#"
    2:9 line 2: a time-point needs a name
    4:1 line 4: expected an edge `A 10 B`, which reads B - A <= 10; this line has 4 words: `"A b 10 Z`
    5:1 line 5: there is no time-point `A`
    "#);
}

#[test]
fn networks_of_other_kinds_are_named_as_what_they_are() {
    let kinds = ["OSTNU", "CSTN", "CSTNU", "CSTNPSU", "PCSTNU", "PSTN", "pstnu", "WISHES"];
    let messages = kinds.map(|kind| {
        let xml =
            format!("<graphml><graph><data key='NetworkType'>{kind}</data><node id='Z'/></graph></graphml>");
        let text = format!("# KIND OF NETWORK\n{kind}\n# Time-Point Names\nZ\n");
        let message = graphml::read(&xml).unwrap_err().remove(0).message;
        let other = plain::read(&text).unwrap_err().remove(0).message;
        assert_eq!(other.split_once(" is ").unwrap().1, message.split_once(" is ").unwrap().1);
        message
    });
    assert_snapshot!(messages.join("\n"), @r"
    the network type is `OSTNU`, an STNU with oracles (events that tell how long something will take before it is over); this kirk reads `STNU` and `STN`
    the network type is `CSTN`, a conditional network (what must hold depends on what is observed); this kirk reads `STNU` and `STN`
    the network type is `CSTNU`, a conditional network with uncertainty (what must hold depends on what is observed); this kirk reads `STNU` and `STN`
    the network type is `CSTNPSU`, a conditional network whose uncertain durations may be shrunk in part; this kirk reads `STNU` and `STN`
    the network type is `PCSTNU`, a conditional network with parameters; this kirk reads `STNU` and `STN`
    the network type is `PSTN`, a probabilistic network (durations have distributions, not bounds); this kirk reads `STNU` and `STN`
    the network type is `pstnu`, a probabilistic network (durations have distributions, not bounds); this kirk reads `STNU` and `STN`
    the network type is `WISHES`; this kirk reads `STNU` and `STN`
    ");
}

#[test]
fn broken_plain_text_gets_a_message_for_each_line() {
    let broken = |text: &str| match plain::read(text) {
        Ok(_) => panic!("this should not be read:\n{text}"),
        Err(problems) => show(text, &problems),
    };
    let all = [
        broken(""),
        broken("A 10 B\n"),
        broken(
            "# KIND OF NETWORK\nCSTNU\n# Num Ordinary Edges\n9\n# Num Contingent Links\nmany\n# Time-Point Names\nZ A C A\n",
        ),
        broken(
            "# Time-Point Names\nA C\n# Ordinary Edges\nA C\nA 10 C ü\nü 1.0000001 Q\nA 1e99 C\n# Contingent Links\nA 4 C\nA x 6 C\n",
        ),
        broken("# Time-Point Names\nZ A C\n# Contingent Links\nA 6 4 C\nZ 1 2 C\nA -1 2 Z\n"),
        broken("# Time-Point Names\nZ A C\n# Contingent Links\nA 4 6 C\nC 4 6 A\n"),
    ];
    assert_snapshot!(all.join("-\n"), @r"
    1:1 there is no section `# Time-Point Names`
    -
    1:1 line 1: expected a section such as `# Time-Point Names` or `# Ordinary Edges` before `A`
    2:1 there is no section `# Time-Point Names`
    -
    2:1 line 2: the kind of network is `CSTNU`, a conditional network with uncertainty (what must hold depends on what is observed); this kirk reads `STNU` and `STN`
    4:1 line 4: the number of ordinary edges is given as `9`, but there are 0
    6:1 line 6: the number of contingent links is given as `many`, but there are 0
    8:7 line 8: the time-point `A` is listed twice
    -
    4:1 line 4: expected an edge `A 10 B`, which reads B - A <= 10; this line has 2 words: `A C`
    5:1 line 5: expected an edge `A 10 B`, which reads B - A <= 10; this line has 4 words: `A 10 C ü`
    6:1 line 6: there is no time-point `ü`
    6:3 line 6: the weight `1.0000001`: this has digits below a microsecond (kirk never rounds a bound)
    6:13 line 6: there is no time-point `Q`
    7:3 line 7: the weight `1e99`: this is more than 10 billion seconds
    9:1 line 9: expected a contingent link `A 4 6 C`, which reads C - A in [4, 6]; this line has 3 words: `A 4 C`
    10:3 line 10: the lower bound `x`: this is not a number of seconds
    11:1 there is no time-point `Z`: the origin, executed first at time 0, has that name
    -
    4:1 line 4: the lower bound 6 is above the upper bound 4: Nature has no duration to choose from. Only what is required may contradict itself: two requirements in `.json`, two ordinary edges in `.stnu` and `.plainstnu`
    5:1 line 5: `C` already ends another contingent link; an event happens once
    6:1 line 6: the bounds [-1, 2] are not 0 <= lower <= upper; Nature needs a duration to choose from
    6:1 line 6: the link ends in the origin, which is executed first
    -
    6:1 the contingent links lead from `A` back to itself: none of them could ever start
    ");
}

#[test]
fn a_network_is_drawn() {
    assert_snapshot!(dot::network(&delayed()), @r#"
    digraph "" {
      rankdir=LR
      node [shape=ellipse, fontname="sans-serif"]
      edge [fontname="sans-serif", fontsize=11]
      n0 [label="start", peripheries=2]
      n1 [label="a\nb \"&amp;\\ <i>"]
      n2 [label="c", style=dashed]
      n0 -> n1 [label="(-∞, 5]"]
      n2 -> n0 [label="(-∞, ∞)"]
      n0 -> n2 [label="[1, 2.5]\nheard after [0, ∞)", color="black:invis:black", style=bold]
    }
    "#);
}

#[test]
fn a_dispatchable_network_is_drawn() {
    let text = "# Time-Point Names\nZ A C X\n# Ordinary Edges\nZ 20 A\nA 0 Z\nX 1 C\nC 6 X\nX 0 Z\n# Contingent Links\nA 2 9 C\n";
    let network = plain::read(text).unwrap();
    let reduction = reduce::reduce(&network).unwrap();
    let form = dispatchable::dispatchable(&reduction, &Precedence::new(&network)).unwrap().unwrap();
    let name = |node: u32| network.label(reduction.event_of[node as usize]).to_string();
    assert_snapshot!(dot::dispatchable(&form, name), @r#"
    digraph "dispatchable" {
      rankdir=LR
      node [shape=ellipse, fontname="sans-serif"]
      edge [fontname="sans-serif", fontsize=11]
      n0 [label="Z", peripheries=2]
      n1 [label="A"]
      n2 [label="X"]
      n3 [label="C", style=dashed]
      n0 -> n1 [label="20"]
      n1 -> n0 [label="0"]
      n2 -> n1 [label="-1"]
      n2 -> n3 [label="1"]
      n3 -> n2 [label="6"]
      n2 -> n1 [label="C:-8", style=dashed]
      n1 -> n3 [label="[2, 9]", color="black:invis:black", style=bold]
    }
    "#);
}
