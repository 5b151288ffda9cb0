//! What is noted on models that are legal and may surprise.

use kirk_network::{Bound, Delay, Duration};

use crate::code::Code;
use crate::diagnostic::Diagnostic;
use crate::episode::{Episode, Kind};
use crate::form::clip;
use crate::lower::called;
use crate::notes::problem::{Moment, NeverLate, Problem};
use crate::source::Span;
use crate::wording::conflict::{stated, sum};

impl From<Problem<'_>> for Diagnostic {
    fn from(problem: Problem<'_>) -> Diagnostic {
        match problem {
            Problem::StartsAtDelayedEnd { activity, before, delay, news } => {
                let (name, heard) = (clip(&activity.name), heard(delay));
                let message = format!("`{name}` starts at the true end of {before}, which is {heard}");
                Diagnostic::note(Code::StartsAtDelayedEnd, activity.span, message)
                    .primary("starts without slack after an end that is heard late")
                    .label(news, "the news is this late")
                    .help(format!(
                        "The two events are one moment, and nobody knows of it before the news. If `{name}` is started by \
                         the executive, put the two into a `(sequence (:slack t) ...)`."
                    ))
            }
            Problem::UselessNews { activity, delay: (spread, delay), duration: (width, duration) } => {
                let name = clip(activity.name.split('#').next().unwrap_or(&activity.name));
                let message = format!("the news of the end of `{name}` comes too irregularly to be of use");
                Diagnostic::note(Code::UselessNews, delay, message)
                    .primary(format!("the delay varies by {spread} s"))
                    .label(duration, format!("the duration varies by only {width} s"))
                    .help(
                        "The plan cannot rely on this news and is made as if it never came. It would help if the delay varied by \
                         less than the duration.",
                    )
            }
            Problem::NeverBinds { bound, limit, most } => {
                let message = format!("this upper bound of {limit} s is never reached");
                Diagnostic::note(Code::NeverBinds, bound, message)
                    .primary(format!("what is inside takes at most {most} s"))
                    .help(
                        "Without slack, the durations inside add up to less than the bound, so it changes nothing. If time may \
                         pass between the activities, give them slack (`:slack t`).",
                    )
            }
            Problem::NeverLate(problem) => never_late(&problem),
        }
    }
}

fn heard(delay: Delay) -> String {
    match delay.max {
        Bound::Finite(max) if max == delay.min => format!("heard {max} s later"),
        Bound::Finite(max) => format!("heard {}-{max} s later", delay.min),
        Bound::Infinite if delay.min == Duration::ZERO => "perhaps never heard".to_string(),
        Bound::Infinite => format!("heard {} s later or never", delay.min),
    }
}

fn never_late(problem: &NeverLate<'_>) -> Diagnostic {
    let NeverLate { activity, others, after, moment, bounds, amounts } = problem;
    let when = match *after {
        Duration::ZERO => format!("the moment {}", happens(*moment)),
        after => format!("exactly {after} s after {}", happens(*moment)),
    };
    let message = format!("`{}` can never start late: it has to start {when}", clip(&activity.name));
    let note = Diagnostic::note(Code::NeverLate, activity.span, message)
        .primary("the first moment at which this can start is also the last");
    let mut places: Vec<(Span, String)> = place(*moment).into_iter().collect();
    for bound in bounds {
        let place = (bound.span, stated(bound, &[], true));
        if !places.contains(&place) {
            places.push(place);
        }
    }
    let others =
        others.iter().map(|it| (it.span, format!("`{}` can never start late either", clip(&it.name))));
    let note = places.into_iter().chain(others).fold(note, |note, (span, text)| note.label(span, text));
    let because = match amounts.is_empty() {
        true => String::new(),
        false => format!("No time is left between these bounds: {} = 0. ", sum(amounts)),
    };
    note.help(format!(
        "{because}Every computer, radio and person takes a moment to react, and then this plan is broken: leave some \
         time, by a longer upper bound or a shorter lower one."
    ))
}

fn happens(moment: Moment<'_>) -> String {
    let name = |episode: &Episode| match episode.kind {
        Kind::Primitive => format!("`{}`", clip(&episode.name)),
        _ => called(episode).elsewhere(),
    };
    match moment {
        Moment::MissionStarts => "the mission starts".to_string(),
        Moment::NewsComes(of) => format!("the news of the end of `{}` comes", clip(&of.name)),
        Moment::Starts(episode) => format!("{} starts", name(episode)),
        Moment::Ends(episode) => format!("{} ends", name(episode)),
        Moment::Unknown => "this can happen".to_string(),
    }
}

/// Where that is, if its name does not say it.
fn place(moment: Moment<'_>) -> Option<(Span, String)> {
    let (episode, happens) = match moment {
        Moment::Starts(episode) => (episode, "starts"),
        Moment::Ends(episode) => (episode, "ends"),
        Moment::MissionStarts | Moment::NewsComes(_) | Moment::Unknown => return None,
    };
    episode.internal.then(|| (episode.span, format!("{} that {happens} then", called(episode).elsewhere())))
}
