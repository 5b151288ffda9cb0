//! The one real clock: mission time from the time since boot, which nobody can set and which goes on while the machine
//! sleeps.

use std::time::Duration as Real;

use kirk_network::Time;
use kirk_runtime::Clocks;

/// Tells mission time, which begins at an anchor and may run faster than the world.
#[derive(Clone, Copy, Debug)]
pub struct Clock {
    /// The time since boot, in microseconds, at the anchor.
    anchor: i64,
    /// Mission time at the anchor.
    at: Time,
    speed: f64,
}

impl Clock {
    /// A clock that stands at `at` now and runs `speed` times as fast as the world.
    pub fn starting(at: Time, speed: f64) -> Clock {
        Clock { anchor: since_boot(), at, speed }
    }

    /// A clock that will stand at zero in a while; before that it is time zero, too.
    pub fn starting_in(wait: Real, speed: f64) -> Clock {
        let anchor = since_boot().saturating_add(wait.as_micros() as i64);
        Clock { anchor, at: Time::ZERO, speed }
    }

    /// How long it is, really, until the anchor.
    pub fn until_anchor(&self) -> Real {
        Real::from_micros((self.anchor - since_boot()).max(0) as u64)
    }

    /// What the clocks of the machine say at the anchor.
    pub fn anchor(&self) -> Clocks {
        let now = clocks();
        let ahead = self.anchor - now.since_boot;
        Clocks { since_boot: self.anchor, calendar: now.calendar + ahead, ..now }
    }

    /// Mission time now.
    pub fn now(&self) -> Time {
        let passed = (since_boot() - self.anchor).max(0) as f64 * self.speed;
        Time::from_micros(self.at.as_micros().saturating_add(passed as i64))
    }

    /// How long it really takes from one mission time to another; nothing if that is past.
    pub fn real(&self, from: Time, to: Time) -> Real {
        let micros = to.as_micros().saturating_sub(from.as_micros()).max(0);
        // Rounded up, so as not to wake a moment too early.
        Real::from_nanos((micros as f64 * 1000.0 / self.speed).ceil() as u64)
    }

    /// How much mission time passes in so many microseconds of real time.
    pub fn mission_micros(&self, real_micros: i64) -> i64 {
        (real_micros as f64 * self.speed) as i64
    }
}

/// What the clocks of the machine say now.
pub fn clocks() -> Clocks {
    let boot = std::fs::read_to_string("/proc/sys/kernel/random/boot_id").ok();
    let calendar = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    Clocks {
        boot: boot.map(|id| id.trim().to_string()),
        since_boot: since_boot(),
        calendar: calendar.map_or(0, |since| since.as_micros() as i64),
    }
}

#[cfg(target_os = "linux")]
fn since_boot() -> i64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::Boottime);
    now.tv_sec * 1_000_000 + now.tv_nsec / 1_000
}

#[cfg(not(target_os = "linux"))]
fn since_boot() -> i64 {
    let now = rustix::time::clock_gettime(rustix::time::ClockId::Monotonic);
    now.tv_sec * 1_000_000 + now.tv_nsec / 1_000
}
