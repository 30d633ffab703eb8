//! Names of parameters as people write them.

/// A parameter, without the unit that its name may end with.
pub(crate) fn label(parameter: &str) -> String {
    // Of a channel, and of a harmonic of a line.
    for channel in ["cos", "sin"] {
        let of = |what: &str| format!("{what} ({channel})");
        let Some((what, which)) = parameter.split_once(&format!("_{channel}")) else {
            continue;
        };
        let number = which.trim_start_matches('_');
        match (what, number) {
            ("k", _) => return of("coefficient k"),
            ("tau", _) => return of("time constant"),
            ("product_into", _) => return format!("fraction × delay into {channel}"),
            ("curve", _) => return of(&format!("Legendre coefficient {number}")),
            ("compression", _) => return of(&format!("compression at the {number} rail")),
            (_, "") => return of(what),
            (_, number) => return of(&format!("{what} of harmonic {number}")),
        }
    }
    match parameter {
        "density_at_1_hz" => "density at 1 Hz".into(),
        "corner_hz" => "corner frequency".into(),
        "tau_s" => "time constant".into(),
        "rms_s" => "jitter, rms".into(),
        "rms" => "noise over signal, rms".into(),
        "share" => "share of the samples".into(),
        "largest" => "largest deviation".into(),
        "compression_upper" => "compression at the upper rail".into(),
        "compression_lower" => "compression at the lower rail".into(),
        _ => {
            let bare = ["_s", "_hz", "_lsb"]
                .into_iter()
                .find_map(|u| parameter.strip_suffix(u));
            bare.unwrap_or(parameter).replace('_', " ")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::label;

    #[test]
    fn parameters_have_proper_labels() {
        for (name, text) in [
            ("delay_s", "delay"),
            ("tau_s", "time constant"),
            ("tau_sin_s", "time constant (sin)"),
            ("frequency_hz", "frequency"),
            ("corner_hz", "corner frequency"),
            ("density_at_1_hz", "density at 1 Hz"),
            ("amplitude_cos", "amplitude (cos)"),
            ("phase_sin_3", "phase of harmonic 3 (sin)"),
            ("product_into_cos_s", "fraction × delay into cos"),
            ("curve_sin_5", "Legendre coefficient 5 (sin)"),
            ("compression", "compression"),
            ("compression_upper", "compression at the upper rail"),
            (
                "compression_cos_lower",
                "compression at the lower rail (cos)",
            ),
            ("change_cos", "change (cos)"),
            ("step_lsb", "step"),
            ("rms_s", "jitter, rms"),
            ("k_cos", "coefficient k (cos)"),
        ] {
            assert_eq!(label(name), text);
        }
    }
}
