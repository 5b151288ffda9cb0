//! The one real clock: mission time from the time since boot, which nobody can set and which goes on while the machine
//! sleeps.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::Duration as Real;

use kirk_network::{Duration, Time};
use kirk_runtime::{Clocks, Speed};

/// Tells mission time, which begins at an anchor and may run faster than the world. Clones are the same clock.
#[derive(Clone, Debug)]
pub struct Clock {
    /// The time since boot, in microseconds, at the anchor; `STANDING` until that is known.
    anchor: Arc<AtomicI64>,
    /// Mission time at the anchor.
    at: Time,
    speed: Speed,
}

const STANDING: i64 = i64::MAX;

impl Clock {
    /// A clock that stands at `at` now and runs.
    pub fn starting(at: Time, speed: Speed) -> Clock {
        Clock { anchor: Arc::new(since_boot().into()), at, speed }
    }

    /// A clock that will stand at zero in a while; before that it is time zero, too.
    pub fn starting_in(wait: Real, speed: Speed) -> Clock {
        let anchor = since_boot().saturating_add(wait.as_micros() as i64);
        Clock { anchor: Arc::new(anchor.into()), at: Time::ZERO, speed }
    }

    /// A clock that stands at zero until it is started.
    pub fn standing(speed: Speed) -> Clock {
        Clock { anchor: Arc::new(STANDING.into()), at: Time::ZERO, speed }
    }

    /// Starts a clock that stands, as if that had been done so long ago, really.
    pub fn start(&self, ago: Duration) {
        self.anchor.store(since_boot().saturating_sub(ago.as_micros()), Ordering::Release);
    }

    /// True until it is started.
    pub fn is_standing(&self) -> bool {
        self.boot_at_anchor() == STANDING
    }

    fn boot_at_anchor(&self) -> i64 {
        self.anchor.load(Ordering::Acquire)
    }

    /// How long it is, really, until the anchor.
    pub fn until_anchor(&self) -> Real {
        Real::from_micros((self.boot_at_anchor() - since_boot()).max(0) as u64)
    }

    /// What the clocks of the machine say at the anchor; what they say now if the clock stands.
    pub fn anchor(&self) -> Clocks {
        let now = clocks();
        if self.is_standing() {
            return now;
        }
        let anchor = self.boot_at_anchor();
        Clocks { since_boot: anchor, calendar: now.calendar.saturating_add(anchor - now.since_boot), ..now }
    }

    /// Mission time now.
    pub fn now(&self) -> Time {
        self.at.saturating_add(self.passed().max(Duration::ZERO))
    }

    /// Mission time now for people: before the anchor it is negative, and counts down.
    pub fn countdown(&self) -> Time {
        if self.is_standing() { self.at } else { self.at.saturating_add(self.passed()) }
    }

    /// How much mission time has passed since the anchor.
    fn passed(&self) -> Duration {
        self.mission(Duration::from_micros(since_boot() - self.boot_at_anchor()))
    }

    /// How long it really takes from one mission time to another; nothing if that is past.
    pub fn real(&self, from: Time, to: Time) -> Real {
        self.speed.real(to.saturating_since(from))
    }

    /// How much mission time passes in so much real time.
    pub fn mission(&self, real: Duration) -> Duration {
        self.speed.mission(real)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_stands_until_it_is_started_and_all_who_have_it_see_that() {
        let clock = Clock::standing(Speed::try_from(1000.0).unwrap());
        let another = clock.clone();
        assert_eq!((clock.now(), clock.countdown(), clock.is_standing()), (Time::ZERO, Time::ZERO, true));
        assert!(clock.until_anchor() > Real::from_secs(1 << 30));
        clock.start(Duration::from_micros(2_000));
        assert!(another.now() >= Time::from_micros(2_000_000) && !another.is_standing());
        assert_eq!(another.until_anchor(), Real::ZERO);
    }

    #[test]
    fn before_its_time_a_clock_says_zero_and_for_people_how_long_there_is() {
        let clock = Clock::starting_in(Real::from_secs(3600), Speed::try_from(2.0).unwrap());
        assert_eq!(clock.now(), Time::ZERO);
        let left = clock.countdown().as_micros();
        assert!((-7_200_000_000..-7_100_000_000).contains(&left), "{left}");
        assert!(clock.anchor().calendar - clocks().calendar > 3_590_000_000);
    }
}
