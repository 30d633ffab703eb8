//! The stimulus `ties` makes what its name says.

use crate::shipped;
use nonius_testvectors::stimulus::named;
use nonius_testvectors::ties::Ties;

#[test]
fn every_rounding_meets_a_tie() {
    for name in shipped::NAMES {
        let design = shipped::design(name);
        let ties = Ties::new(&design);
        let stimuli = named(&design, 2000);
        let searched = stimuli.iter().find(|s| s.name == "ties").expect("ties");
        let by_search = ties.count(&design, &searched.samples);
        let mut all = vec![0; by_search.len()];
        for stimulus in &stimuli {
            let counts = ties.count(&design, &stimulus.samples);
            all.iter_mut().zip(counts).for_each(|(all, n)| *all += n);
        }
        for ((value, searched), all) in ties.names().zip(&by_search).zip(&all) {
            let value = value.unwrap_or("shifted gradient");
            println!("{name}: {value}: {searched} ties of the search, {all} in all stimuli");
            assert!(*all > 0, "{name}: {value} is never half way");
            // A large gear drops no bit before the parameters have settled: that is left to the other stimuli.
            assert!(
                *searched > 0 || value == "shifted gradient",
                "{name}: {value}"
            );
        }
    }
}
