//! Files and command lines: what is said before and beside the program itself.

use super::Page;

pub(super) const CANNOT_READ: Page = Page {
    meaning: "The file could not be read: it is not there, it may not be read, it is a directory, or it is larger than anything
kirk reads (16 MiB of RMPL, 64 MiB of network). `-` stands for standard input. Nothing was compiled and nothing executed.",
    wrong: "",
    right: "",
};

pub(super) const BAD_NETWORK: Page = Page {
    meaning: "A network file does not say what a network file says. The message names the element, such as `requirements[3]`
(counted from 0), and what was expected there. A kirk network is a JSON object with `format`, `origin` and `events`, and
usually `requirements` and `contingents`; numbers are seconds, exact to a microsecond, and nothing unknown is skipped. All
problems are reported at once.",
    wrong: "",
    right: "",
};

pub(super) const NUMBERS_TOO_LARGE: Page = Page {
    meaning: "Each number is in range, but along some path through the network they add up to more than 18,000 years of
microseconds. kirk computes exactly or not at all, so it gives no verdict. Look for a bound that was meant to be infinite:
write `:infinity`, or leave the bound out.",
    wrong: "",
    right: "",
};

pub(super) const NO_PROGRAMS: Page = Page {
    meaning: "`-P`/`--package` and `--entry` say which program of an RMPL source is meant. A network file (`.json`, `.stnu`,
`.plainstnu`) has events and constraints and no programs, so the option could only be ignored, and kirk ignores nothing
silently. Leave it out, or give the source the network was compiled from.",
    wrong: "",
    right: "",
};

pub(super) const FOR_ONE_ALONE: Page = Page {
    meaning: "This mission has a `define-team`: several execute it, each on what it hears. The command knows how one executive that hears
everything would do, and its answer would be wrong of the team. `kirk check` judges the team, `kirk compile --agent NAME` prints
what one agent executes, and `kirk run --simulate` executes all of them.",
    wrong: "",
    right: "",
};

pub(super) const BAD_OBSERVATION: Page = Page {
    meaning: "`--observe EVENT@T` says that news of EVENT arrives T seconds after the start; a file given with `--observations` is
a JSON object of event: time. EVENT must be the end of a contingent duration, because everything else is dispatched by
kirk and not observed. Any of the names of a merged event will do, in any case, also as `+DRIVE::END+`. The news of an event
arrives once.",
    wrong: "",
    right: "",
};

pub(super) const IMPOSSIBLE_OBSERVATION: Page = Page {
    meaning: "The model rules this news out: given when the activity was started, how long it can take and how late its news can
be, the news cannot arrive at that time. A simulation with it would show nothing that can happen. Either the observation is
wrong, or the bounds of the program are. What becomes of the mission if it comes all the same is what `kirk run --simulate --what-if`
rehearses, and `kirk query --heard` answers; but nobody can hear of what has not begun.",
    wrong: "",
    right: "",
};

pub(super) const BAD_RECORD: Page = Page {
    meaning: "`kirk verify` reads the record of an execution as `kirk run --format json` writes it (`kirk-execution/1`): a JSON object
with `program`, `outcome`, `makespan` and `rows`. The message says what is missing or unknown.",
    wrong: "",
    right: "",
};
