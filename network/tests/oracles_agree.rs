//! The oracles against each other, and against networks whose verdict can be worked out by hand.

mod oracle;

use oracle::{closure, game, random};

#[test]
fn rates() {
    for (name, shape) in [
        ("tiny", random::Shape::tiny()),
        ("chained", random::Shape::tiny().chained()),
        ("delayed", random::Shape::tiny_delayed()),
        ("delayed chained", random::Shape::tiny_delayed().chained()),
    ] {
        let mut yes = 0;
        let mut slow = Vec::new();
        let begin = std::time::Instant::now();
        for seed in 0..1000 {
            let net = random::network(seed, &shape);
            let b = std::time::Instant::now();
            let verdict = game::controllable(&net);
            slow.push((b.elapsed(), seed));
            yes += u32::from(verdict);
            if !name.contains("delayed") && verdict != closure::dynamically_controllable(&net) {
                let small =
                    random::shrunk(&net, |n| game::controllable(n) != closure::dynamically_controllable(n));
                println!("DISAGREE game {} {}", game::controllable(&small), random::describe(&small));
            }
        }
        slow.sort();
        println!("{name}: {yes} of 1000, {:?}, slowest {:?}", begin.elapsed(), &slow[996..]);
    }
    for (name, shape) in [("medium", random::Shape::medium()), ("mc", random::Shape::medium().chained())] {
        let begin = std::time::Instant::now();
        let mut yes = 0;
        for seed in 0..200 {
            yes += u32::from(closure::dynamically_controllable(&random::network(seed, &shape)));
        }
        println!("{name}: {yes} of 200, {:?}", begin.elapsed());
    }
}
