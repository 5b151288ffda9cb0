//! The screen without a terminal: what is seen of missions at different sizes, and what keys do.

use std::time::Duration as Real;

use kirk_executive::{Acknowledgement, Happening, Ignored, Next, Possible, Snapshot, Waits};
use kirk_network::Time;
use kirk_network::time::Interval;
use kirk_runtime::{How, Outcome, Pending, Row, Why};
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use ratatui::style::Color;

use super::input::Key;
use super::keys::REST;
use super::state::{Action, Moment, State};
use super::view::view;

fn at(second: i64) -> Time {
    Time::from_micros(second * 1_000_000)
}

fn moment(second: i64) -> Moment {
    Moment { mission: at(second), real: Real::from_secs(second as u64) }
}

fn row(event: &str, time: i64, how: How) -> Row {
    let time = Some(at(time));
    Row { event: event.to_string(), time, how, observed: None, happened: None, truth: None, because: None }
}

fn possible(event: &str, from: i64, until: Option<i64>) -> Possible {
    Possible { event: event.to_string(), from: at(from), until: until.map(at) }
}

/// A mission at 22 s, with some of everything.
fn mission() -> Snapshot {
    Snapshot {
        at: at(22),
        program: "main".to_string(),
        outcome: Outcome::Running,
        failure: None,
        rows: vec![
            row("main:start", 0, How::Dispatched),
            row("human-downlink-science:start", 0, How::Dispatched),
            Row {
                observed: Some(Some(Time::from_micros(21_967_811))),
                happened: Some(Interval::new(at(15), Time::from_micros(16_967_811))),
                ..row("human-downlink-science:end", 22, How::Observed)
            },
            row("robot-drilling:start", 22, How::Dispatched),
        ],
        next: Some(Next { at: at(48), event: "robot-drilling:end".to_string(), how: How::Imagined }),
        possible: vec![
            possible("robot-drilling:end", 44, Some(49)),
            possible("dust-storm:end", 9, None),
            possible("battery-charged:end", 12, Some(40)),
            possible("tea:end", 3, Some(20)),
        ],
        waits: None,
        pending: vec![
            Pending {
                name: "camera-on:start".to_string(),
                latest: Some(at(30)),
                attempts: 2,
                again: Some(at(24)),
                reason: "exit status: 7".to_string(),
            },
            Pending {
                name: "upload:start".to_string(),
                latest: None,
                attempts: 1,
                again: None,
                reason: String::new(),
            },
        ],
    }
}

/// A screen that has seen a mission at a time.
fn seen(snapshot: Snapshot) -> State {
    let mut state = State::default();
    let now = Moment { mission: snapshot.at, real: Real::ZERO };
    state.see(snapshot, now);
    state.visible = 10;
    state
}

/// The same, with something to say.
fn talking() -> State {
    let mut state = seen(mission());
    state.note(&Happening::Failed {
        at: at(20),
        event: "camera-on:start".to_string(),
        id: "run/camera-on:start".to_string(),
        reason: "exit status: 7".to_string(),
    });
    state.answered(
        Acknowledgement {
            accepted: vec!["human-downlink-science:end".to_string()],
            ignored: vec![Ignored { event: "tea:start".to_string(), why: Why::NotNatures }],
        },
        moment(22),
    );
    state
}

fn screen(state: &State, (width, height): (u16, u16), color: bool) -> TestBackend {
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal
        .draw(|frame| {
            view(state, at(22), color, frame.buffer_mut());
        })
        .unwrap();
    terminal.backend().clone()
}

fn text(state: &State, size: (u16, u16)) -> String {
    screen(state, size, false).to_string()
}

#[test]
fn a_narrow_screen_has_the_keys_and_the_latest_rows() {
    insta::assert_snapshot!(text(&talking(), (40, 12)));
}

#[test]
fn a_usual_screen_has_everything_one_below_the_other() {
    insta::assert_snapshot!(text(&talking(), (80, 24)));
}

#[test]
fn a_wide_screen_has_the_timetable_beside_the_rest() {
    insta::assert_snapshot!(text(&talking(), (120, 14)));
}

#[test]
fn before_the_first_look_there_is_only_a_word() {
    assert_eq!(text(&State::default(), (24, 1)), "\"starting the mission    \"\n");
}

#[test]
fn more_events_than_lines_are_pages() {
    let many = (0..20).map(|number| possible(&format!("survey-{number}:end"), number, Some(60))).collect();
    let mut state = seen(Snapshot { possible: many, ..mission() });
    insta::assert_snapshot!("first_page", text(&state, (60, 16)));
    state.key(Key::Tab, moment(22));
    insta::assert_snapshot!("second_page", text(&state, (60, 16)));
}

#[test]
fn long_and_wide_names_are_cut_in_the_middle() {
    let long = "a-very-long-name-of-a-program-that-says-all-there-is-to-say-about-it:end";
    let wide = "火星探査車のカメラの電源を入れて写真を撮る:end";
    let rows = vec![row(long, 3, How::Dispatched), row(wide, 1_000_000, How::Imagined)];
    let possible = vec![possible(wide, 3, Some(1_000_000)), possible(long, 3, None)];
    let next = Some(Next { at: at(30), event: long.to_string(), how: How::Dispatched });
    let state = seen(Snapshot { program: wide.to_string(), rows, possible, next, ..mission() });
    insta::assert_snapshot!(text(&state, (64, 12)));
}

#[test]
fn names_cannot_send_commands_to_the_terminal() {
    let name = "\u{1b}[2Jx\u{7}\r\n\u{9b}31m";
    let mut state = seen(Snapshot {
        program: name.to_string(),
        rows: vec![row(name, 3, How::Dispatched)],
        possible: vec![possible(name, 3, None)],
        ..mission()
    });
    let warning = Happening::Warning { at: Time::ZERO, text: name.to_string() };
    state.note(&warning);
    let screen = screen(&state, (80, 24), true);
    let cells = screen.buffer().content();
    assert!(cells.iter().all(|cell| !cell.symbol().contains(char::is_control)));
    assert!(cells.iter().any(|cell| cell.symbol() == "x"));
}

#[test]
fn before_time_zero_it_is_said_what_is_waited_for() {
    let (rows, possible, pending) = (Vec::new(), Vec::new(), Vec::new());
    let before =
        Snapshot { rows, possible, pending, next: None, waits: Some(Waits::Hour), at: at(0), ..mission() };
    let head = |state: &State, now: i64, width: u16| {
        let mut terminal = Terminal::new(TestBackend::new(width, 3)).unwrap();
        terminal.draw(|frame| _ = view(state, at(now), false, frame.buffer_mut())).unwrap();
        let lines = terminal.backend().to_string().replace('"', "");
        lines.lines().take(2).map(|line| line.trim_end().to_string()).collect::<Vec<_>>()
    };
    let hour = seen(before.clone());
    assert_eq!(
        head(&hour, -75, 70),
        [
            " main  -75 s  waiting                            ? help   Ctrl-C stop",
            "next: the mission begins in 75 s"
        ]
    );
    let driver = seen(Snapshot { waits: Some(Waits::Driver("fly:start".to_string())), ..before });
    assert_eq!(
        head(&driver, 0, 70),
        [
            " main  0 s  waiting                              ? help   Ctrl-C stop",
            "next: the mission begins when the driver has confirmed fly:start"
        ]
    );
}

#[test]
fn any_size_will_do() {
    let mut help = talking();
    help.key(Key::Char('?'), moment(22));
    let mut asking = talking();
    asking.key(Key::Interrupt, moment(22));
    for state in [talking(), help, asking, State::default(), seen(Snapshot { rows: vec![], ..mission() })] {
        for width in (0..52).chain([109, 110, 111, 300]) {
            for height in (0..16).chain([30, 200]) {
                screen(&state, (width, height), true);
            }
        }
    }
}

#[test]
fn colours_say_nothing_that_words_do_not() {
    let (with, without) = (screen(&talking(), (80, 24), true), screen(&talking(), (80, 24), false));
    assert_eq!(with.to_string(), without.to_string());
    assert!(with.buffer().content().iter().any(|cell| cell.fg != Color::Reset));
    assert!(without.buffer().content().iter().all(|cell| cell.fg == Color::Reset && cell.bg == Color::Reset));
}

#[test]
fn a_key_reports_its_event() {
    let mut state = seen(mission());
    // Keys are given out in the order of the list; what is possible now needs no second thought.
    assert_eq!(state.key(Key::Char('2'), moment(22)), Action::Observe("dust-storm:end".to_string()));
    assert_eq!(state.key(Key::Char('3'), moment(22)), Action::Observe("battery-charged:end".to_string()));
    assert_eq!(state.key(Key::Char('5'), moment(22)), Action::Nothing);
    assert_eq!(state.key(Key::Char('!'), moment(22)), Action::Nothing);
}

#[test]
fn news_that_would_break_the_model_is_asked_for_twice() {
    for (key, event, question) in [
        ('1', "robot-drilling:end", "robot-drilling:end is not possible before 44 s."),
        ('4', "tea:end", "tea:end was to be heard by 20 s."),
    ] {
        let mut state = seen(mission());
        assert_eq!(state.key(Key::Char(key), moment(22)), Action::Nothing);
        assert!(state.question().unwrap().starts_with(question), "{:?}", state.question());
        // Another key is not a yes.
        state.key(Key::Down, moment(22));
        assert_eq!(state.question(), None);
        assert_eq!(state.key(Key::Char(key), moment(22)), Action::Nothing);
        assert_eq!(state.key(Key::Char(key), moment(23)), Action::Observe(event.to_string()));
    }
}

#[test]
fn a_question_lapses() {
    let mut state = seen(mission());
    state.key(Key::Interrupt, moment(0));
    state.tick(moment(4));
    assert_eq!(state.question(), Some("Press Ctrl-C again to stop the mission."));
    state.tick(moment(5));
    assert_eq!(state.question(), None);
    assert_eq!(state.key(Key::Interrupt, moment(5)), Action::Nothing);
    assert_eq!(state.key(Key::Interrupt, moment(6)), Action::Stop);
    // Whoever does not want to wait for the mission to stop leaves.
    assert_eq!(state.key(Key::Interrupt, moment(6)), Action::Leave);
}

#[test]
fn a_key_whose_event_was_heard_says_so() {
    let mut state = seen(mission());
    let mut heard = mission();
    heard.possible.remove(1);
    heard.possible.push(possible("next:end", 0, None));
    state.see(heard, moment(0));
    assert_eq!(state.key(Key::Char('2'), moment(22)), Action::Nothing);
    let said = state.log.latest().next().map(|note| note.text.clone());
    assert_eq!(said.as_deref(), Some("2 was dust-storm:end, which has been heard"));
    assert_eq!(state.key(Key::Char('5'), moment(22)), Action::Observe("next:end".to_string()));
    // Once the key has rested it may be given out again.
    state.tick(Moment { mission: at(30), real: REST });
    assert_eq!(state.key(Key::Char('2'), moment(30)), Action::Nothing);
    assert_eq!(state.log.latest().count(), 1);
}

#[test]
fn a_key_pressed_while_the_help_hides_the_events_only_closes_it() {
    let mut state = seen(mission());
    assert_eq!(state.key(Key::Char('?'), moment(22)), Action::Nothing);
    insta::assert_snapshot!(text(&state, (40, 14)));
    assert_eq!(state.key(Key::Char('2'), moment(22)), Action::Nothing);
    assert!(!state.help);
    assert_eq!(state.key(Key::Char('2'), moment(22)), Action::Observe("dust-storm:end".to_string()));
}

#[test]
fn the_timetable_stays_where_it_was_scrolled_to_until_its_end() {
    let rows = |count: i64| (0..count).map(|n| row(&format!("e{n}"), n, How::Dispatched)).collect();
    let mut state = seen(Snapshot { rows: rows(50), ..mission() });
    assert_eq!(state.first, None);
    state.key(Key::Up, moment(22));
    assert_eq!(state.first, Some(39));
    state.key(Key::PageUp, moment(22));
    assert_eq!(state.first, Some(30));
    state.see(Snapshot { rows: rows(60), ..mission() }, moment(22));
    assert_eq!(state.first, Some(30));
    assert!(text(&state, (80, 24)).contains(" later: End)"));
    state.key(Key::Home, moment(22));
    state.key(Key::Up, moment(22));
    assert_eq!(state.first, Some(0));
    state.key(Key::PageDown, moment(22));
    assert_eq!(state.first, Some(9));
    for _ in 0..10 {
        state.key(Key::PageDown, moment(22));
    }
    // At the end it follows again.
    assert_eq!(state.first, None);
}
