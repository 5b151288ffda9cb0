//! `kirk run` in real time, and `kirk resume`.

use std::io;
use std::sync::mpsc::{Receiver, channel};

use jiff::Timestamp;
use kirk_compiler::episode::{Episode, Kind};
use kirk_executive::{
    Assignment, Driver, Ended, Http, Options, Ready, Resumption, Said, Screen, Zero, begin,
};
use kirk_network::Duration;
use kirk_picture::{Chart, Look};
use kirk_runtime::{
    Dispatcher, Execution, Outcome, Plan, Row, Scope, handovers, leave_out_natures, merge_companions,
};

use crate::args::{
    Common, CompanionName, DriverEvents, DriverStarts, Live, Resume, Run, ScreenWhen, Show, ShowFormat,
    StrategyName,
};
use crate::input::Loaded;
use crate::json::line;
use crate::live;
use crate::output::{self, Status, complain, print, remark};
use crate::replay::print_journal;
use crate::show::drawn;
use crate::timetable::timetable;
use crate::watch;
use crate::why::why;

/// Executes a proven mission in real time.
pub(crate) fn execute(arguments: &Run, common: &Common, input: &Loaded, plan: Plan) -> io::Result<Status> {
    let Some(network) = &input.network else { return Ok(Status::Wrong) };
    let options = match options(arguments) {
        Ok(options) => options,
        Err(message) => return wrong(&message),
    };
    let activities = input.compilation().and_then(|compilation| compilation.episodes.as_ref());
    let activities = activities.map(activities_of);
    let scope = match arguments.live.driver_events {
        DriverEvents::Starts => Scope::Starts,
        DriverEvents::All => Scope::All,
    };
    let mut handovers = handovers(plan.network(), activities.as_deref(), scope);
    // Before starts are left out: what the middleware begins by itself has its name all the same.
    if arguments.live.companion() == CompanionName::Merged {
        merge_companions(plan.network(), &mut handovers);
    }
    if arguments.live.driver_starts() == DriverStarts::Own {
        leave_out_natures(plan.network(), &mut handovers);
    }
    if options.driver.is_some() && handovers.is_empty() && !common.quiet {
        remark(
            "warning: the driver will hear of nothing: no event starts an activity (`x:start` with an `x:end`); \
             `--driver-events all` hands over every event of a network",
        );
    }
    let program = input.program(&arguments.selection);
    let mission = Assignment { program, network: network.clone(), plan, handovers };
    let screen = match has_screen(options.screen) {
        Ok(screen) => screen,
        Err(message) => return wrong(&message),
    };
    let (out, said) = channel();
    match begin(mission, options, arguments.live.journal.as_deref(), out) {
        Ok(ready) => {
            let stdin_taken = arguments.files.iter().any(|file| file == "-");
            finish(ready, said, screen, stdin_taken, arguments.show, common)
        }
        Err(message) => wrong(&message),
    }
}

/// Goes on with a mission that was interrupted.
pub(crate) fn resume(arguments: &Resume, common: &Common) -> io::Result<Status> {
    let note = |text: String| {
        if !common.quiet {
            remark(&text);
        }
    };
    let show = arguments.show;
    let wanted = arguments.screen.map(screen);
    if let Some(Err(message)) = wanted.map(has_screen) {
        return wrong(&message);
    }
    let (out, said) = channel();
    match kirk_executive::resume(&arguments.journal, arguments.at, out, note) {
        Ok(Resumption::Ready(ready)) => {
            // The mission is to go on, also where there is no such terminal as there was when it was begun.
            let screen = has_screen(wanted.unwrap_or(ready.options().screen)).unwrap_or(false);
            finish(*ready, said, screen, false, show, common)
        }
        Ok(Resumption::Over(execution)) => {
            if !common.quiet {
                remark("the mission is over; there is nothing to go on with");
            }
            match show.why {
                true => {
                    print_journal(&arguments.journal, None, show, &Common { quiet: true, ..common.clone() })
                }
                false => show.execution(&execution, None, || Chart::of_execution(&execution)),
            }
        }
        Err(message) => wrong(&message),
    }
}

/// The same with what decided the time of each row.
fn with_why(execution: &Execution, dispatcher: &Dispatcher) -> Execution {
    let because = |row: &Row| Some(why(dispatcher, row)).filter(|why| !why.is_empty());
    let rows = execution.rows.iter().map(|row| Row { because: because(row), ..row.clone() }).collect();
    Execution { rows, ..execution.clone() }
}

impl Show {
    /// Prints an execution by a dispatcher, if that is at hand, and says by the exit status how it ended. `chart`: what is to be seen
    /// of the mission.
    pub(crate) fn execution(
        self,
        execution: &Execution,
        by: Option<&Dispatcher>,
        chart: impl FnOnce() -> Chart,
    ) -> io::Result<Status> {
        let text = match (self.format, self.format.picture()) {
            (_, Some(picture)) => drawn(&chart().executed(execution), Look::default(), picture),
            (ShowFormat::Json, _) => match by.filter(|_| self.why) {
                Some(dispatcher) => line(&with_why(execution, dispatcher))?,
                None => line(execution)?,
            },
            _ => timetable(execution, by.filter(|_| self.why)),
        };
        match print(&text) {
            // The terminal is gone; the mission was executed all the same.
            Err(error) if error.raw_os_error() == Some(rustix::io::Errno::IO.raw_os_error()) => {}
            printed => printed?,
        }
        Ok(if execution.outcome == Outcome::Completed { Status::Yes } else { Status::No })
    }
}

fn finish(
    ready: Ready,
    said: Receiver<Said>,
    screen: bool,
    stdin_taken: bool,
    show: Show,
    common: &Common,
) -> io::Result<Status> {
    let address = ready.address().map(|address| format!("news is heard at http://{address}/"));
    let zero = zero(ready.options()).filter(|_| !screen);
    let greet = || address.iter().chain(&zero).filter(|_| !common.quiet).for_each(|line| remark(line));
    let desk = ready.desk();
    kirk_executive::stop_on_signals(desk.clone());
    let watching = if screen {
        greet();
        let options = live::Options { color: output::colors(common.color), greeting: address };
        watch::screen(desk, options, said, common.quiet)
    } else {
        let watching = watch::print(&desk, said, common.quiet);
        // Whoever reads where news is heard may send some at once, and what becomes of it is told to those who watch by then.
        greet();
        if !stdin_taken && !live::is_in_background() {
            watch::read_lines(desk);
        }
        watching
    };
    let ended = ready.run(show.internal);
    // It ends when it has said that the mission is over.
    let _ = watching.join();
    if !common.quiet {
        say_lateness(&ended);
    }
    let dispatcher = ended.executive.dispatcher();
    let chart = || Chart::of_network(&ended.execution.program, dispatcher.network());
    show.execution(&ended.execution, Some(dispatcher), chart)
}

/// True if the mission is shown on a screen, with a key for each event; an error if it is to be and cannot.
fn has_screen(wanted: Screen) -> Result<bool, String> {
    match (wanted, live::obstacle()) {
        (Screen::Never, _) => Ok(false),
        (Screen::Auto, _) => Ok(live::is_there()),
        (Screen::Always, None) => Ok(true),
        (Screen::Always, Some(why)) => {
            Err(format!("there can be no screen, as `--screen always` wants: {why}"))
        }
    }
}

fn screen(when: ScreenWhen) -> Screen {
    match when {
        ScreenWhen::Auto => Screen::Auto,
        ScreenWhen::Never => Screen::Never,
        ScreenWhen::Always => Screen::Always,
    }
}

/// When the mission begins, if that is not at once.
fn zero(options: &Options) -> Option<String> {
    match options.zero {
        Zero::Soon => None,
        Zero::At(calendar) => {
            Timestamp::from_microsecond(calendar).ok().map(|at| format!("time zero of the mission is {at}"))
        }
        Zero::DriverConfirms { within } => Some(format!(
            "the clock of the mission stands until the driver first confirms, for {} s at most",
            within.as_secs_f64()
        )),
    }
}

fn say_lateness(ended: &Ended) {
    let percentile = |percent| ended.lateness.percentile(percent).unwrap_or(Duration::ZERO);
    if ended.lateness.count() > 0 {
        remark(&format!(
            "{} dispatches, late by {} s in the median, {} s at the 99th percentile, {} s at most",
            ended.lateness.count(),
            percentile(50),
            percentile(99),
            percentile(100)
        ));
    }
    if ended.stopped.is_some() {
        remark("if it has a journal, `kirk resume` goes on with it");
    }
}

fn wrong(message: &str) -> io::Result<Status> {
    complain(message);
    Ok(Status::Wrong)
}

fn options(arguments: &Run) -> Result<Options, String> {
    let live = &arguments.live;
    let driver = match (&live.driver_command, &live.driver, &live.driver_url) {
        (Some(template), ..) => Some(Driver::Command(template.clone())),
        (_, Some(driver), _) => match driver.strip_prefix("stdio:").map(str::trim) {
            Some(command) if !command.is_empty() => Some(Driver::Stdio(command.to_string())),
            _ => {
                return Err(format!(
                    "`--driver {driver}`: expected `stdio:` and a command, such as `stdio:./robot.py`"
                ));
            }
        },
        (.., Some(url)) => Some(Driver::Url(url.clone())),
        _ => None,
    };
    let http = live.port.map(|port| {
        let Live { bind, token_file, .. } = live;
        Http { bind: bind.clone(), port, token_file: token_file.clone() }
    });
    Ok(Options {
        optimistic: arguments.strategy() == StrategyName::Optimistic,
        speed: live.speed,
        tolerance: live.tolerance,
        driver,
        driver_timeout: live.driver_timeout,
        http,
        on_failure: live.on_failure.clone(),
        screen: screen(arguments.screen()),
        zero: match (live.start_at, live.wait_for_driver) {
            (Some(calendar), _) => Zero::At(calendar),
            (None, Some(within)) => Zero::DriverConfirms { within },
            (None, None) => Zero::Soon,
        },
    })
}

/// The names of the activities of a mission: every occurrence of a primitive program.
fn activities_of(episode: &Episode) -> Vec<String> {
    let mut names = Vec::new();
    let mut open = vec![episode];
    while let Some(episode) = open.pop() {
        if episode.kind == Kind::Primitive && !episode.internal {
            names.push(episode.name.clone());
        }
        open.extend(&episode.parts);
    }
    names
}
