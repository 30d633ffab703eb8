//! The text of a draft: TOML with a comment beside each number.

use std::fmt::Write as _;

use super::draft::Draft;

impl Draft {
    /// The text of its `design.toml`.
    pub(super) fn toml(&self) -> String {
        let mut out = String::new();
        let line = |key: &str, value: String, note: &str| {
            let text = format!("{key} = {value}");
            if note.is_empty() {
                format!("{text}\n")
            } else {
                format!("{text:<40} # {note}\n")
            }
        };
        let number = |v: f64| {
            if v != 0.0 && !(1e-4..1e7).contains(&v.abs()) {
                format!("{v:e}")
            } else if v.fract() == 0.0 {
                format!("{v:.1}")
            } else {
                format!("{v}")
            }
        };
        let real = |key: &str, v: &(f64, String)| line(key, number(v.0), &v.1);
        let _ = writeln!(out, "# {}", self.head);
        let _ = writeln!(
            out,
            "name = {:?}\ndescription = {:?}\n",
            self.name, self.description
        );
        out += "[sensor]\n";
        out += &real("amplitude", &self.amplitude);
        for (key, promise) in self.promises() {
            out += &line(key, number(promise.value), &promise.comment());
        }
        out += &real("noise_rms", &self.noise_rms);
        out += &real("speed_max_periods_per_s", &self.speed_max);
        match self.scale_period_m {
            Some(length) => {
                out += &line("scale_period_m", number(length), "for positions in metres")
            }
            None => {
                out += "# scale_period_m = 20e-6                # linear scales: for positions in metres\n"
            }
        }
        match self.periods_per_revolution {
            Some(n) => out += &line("periods_per_revolution", format!("{n}.0"), ""),
            None => out += "# periods_per_revolution = 1024         # rotary scales\n",
        }
        out += "\n[adc]\n";
        out += &line("bits", self.bits.0.to_string(), &self.bits.1);
        out += &real("full_scale", &self.full_scale);
        out += &line("middle", number(self.middle), "middle of the ADC's range");
        out += &line(
            "coding",
            "\"twos_complement\"".into(),
            "or \"offset_binary\"",
        );
        out += &real("sample_rate_hz", &self.sample_rate);
        out += "\n[loop]\n";
        out += &line("method", "3".into(), "of the paper: 1, 2 or 3");
        out += &line("type", "2".into(), "no lag at constant speed");
        out += &real("bandwidth_hz", &self.bandwidth);
        out += "\n[calibration]\n";
        out += &line(
            "parameters",
            "5".into(),
            "0 (off), 4 (gains, offsets), 5 (and phase), 8, 9 (and bends)",
        );
        out += "# recall = false                        # smaller; a signal that fades and comes back leaves its mark for some tens of periods\n";
        out += "\n# [correction]\n";
        out += "# channel_skew_s = 1e-6                 # sin is sampled so much later than cos\n";
        out += "# [[correction.harmonics]]              # one for each order: amplitude * cos(order * angle + phase) more\n";
        out += "# order = 4\n# amplitude_cos = 0.01                  # of the amplitude\n# phase_cos = 0.5                       # rad\n";
        out += "# amplitude_sin = 0.01\n# phase_sin = -1.0\n";
        out += "\n[accuracy]\n";
        out += &line(
            "rms_periods",
            number(self.accuracy),
            "the finest that sensor, ADC and loop allow",
        );
        out += "\n[chip]\n";
        out += &line(
            "multipliers",
            "1".into(),
            "1, 2, ... or \"all\": as many as save clocks",
        );
        out += "\n# [formats]                             # any word length in place of the chosen one: see\n";
        out += "# signal_fraction = 16                  # budget.words of design.json for keys, values and limits\n";
        out
    }
}
