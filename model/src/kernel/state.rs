//! What the chip remembers, what it is given, and what it shows.

use crate::bundle::bundle;

bundle! {
    /// The registers, as they stand before a sample. All are zero after reset.
    State {
        /// α̂, the phase estimate: turns in [0, 1).
        alpha_hat,
        /// Whole periods; the unit is the counter's whole range.
        count,
        /// α̂ one sample ago (Method 1).
        alpha_hat_previous,
        /// Phase increment per sample, turns.
        rate,
        /// e one sample ago, radians.
        error_previous,
        /// θ1 less its nominal value.
        theta_1_deviation,
        /// θ2, nominally 0.
        theta_2_deviation,
        /// θ3 less its nominal value.
        theta_3_deviation,
        /// θ4, nominally 0.
        theta_4_deviation,
        /// θ5, nominally 0.
        theta_5_deviation,
        /// θ6: second-order bend of the cosine.
        theta_6_deviation,
        /// θ7: second-order bend of the sine.
        theta_7_deviation,
        /// θ8: third-order bend of both channels.
        theta_8_deviation,
        /// θ9: third-order bend that turns the pair and changes no radius.
        theta_9_deviation,
        /// Confidence of the lock detector.
        lock_level,
        /// Loop gear: 0 widest, the last is the designed bandwidth.
        loop_gear,
        /// γ gear: 0 largest.
        gamma_gear,
        /// Quiet periods kept in this γ gear, or since a recall.
        gear_periods,
        /// Periods with a large residual; with better parameters known, less those without.
        held_periods,
        /// Samples with signal but no lock, until γ has settled; unit: its whole range.
        unlocked_samples,
        /// Periods in the first γ gear that failed with bends near their bounds.
        failed_periods,
        /// Position, modulo 4 periods, where the map of sectors was last cleared.
        travel_origin,
        /// Lowest sector seen since, relative to the origin.
        travel_low,
        /// Highest sector seen since, relative to the origin.
        travel_high,
        /// ∇α̂ by θ1, radians (recursion 11).
        alpha_gradient_1,
        /// Increment per sample of alpha_gradient_1, radians.
        alpha_gradient_rate_1,
        /// w1 − ∇α̂ one sample ago.
        alpha_gradient_error_1,
        /// ∇α̂ by θ2, radians (recursion 11).
        alpha_gradient_2,
        /// Increment per sample of alpha_gradient_2, radians.
        alpha_gradient_rate_2,
        /// w2 − ∇α̂ one sample ago.
        alpha_gradient_error_2,
        /// ∇α̂ by θ3, radians (recursion 11).
        alpha_gradient_3,
        /// Increment per sample of alpha_gradient_3, radians.
        alpha_gradient_rate_3,
        /// w3 − ∇α̂ one sample ago.
        alpha_gradient_error_3,
        /// ∇α̂ by θ4, radians (recursion 11).
        alpha_gradient_4,
        /// Increment per sample of alpha_gradient_4, radians.
        alpha_gradient_rate_4,
        /// w4 − ∇α̂ one sample ago.
        alpha_gradient_error_4,
        /// ∇α̂ by θ5, radians (recursion 11).
        alpha_gradient_5,
        /// Increment per sample of alpha_gradient_5, radians.
        alpha_gradient_rate_5,
        /// w5 − ∇α̂ one sample ago.
        alpha_gradient_error_5,
        /// ∇α̂ along the direction that no radius shows, radians (recursion 11).
        null_gradient,
        /// Increment per sample of null_gradient, radians.
        null_gradient_rate,
        /// w − null_gradient one sample ago.
        null_gradient_error,
        /// Gathered gradient by θ1.
        gathered_1,
        /// Gathered gradient by θ2.
        gathered_2,
        /// Gathered gradient by θ3.
        gathered_3,
        /// Gathered gradient by θ4.
        gathered_4,
        /// Gathered gradient by θ5.
        gathered_5,
        /// Gathered gradient by θ6.
        gathered_6,
        /// Gathered gradient by θ7.
        gathered_7,
        /// Gathered gradient by θ8.
        gathered_8,
        /// Samples since the last whole period of travel.
        travel_samples,
        /// θ1 less its nominal value, as the running period of travel has it so far.
        running_1,
        /// θ2 less its nominal value, as the running period of travel has it so far.
        running_2,
        /// θ3 less its nominal value, as the running period of travel has it so far.
        running_3,
        /// θ4 less its nominal value, as the running period of travel has it so far.
        running_4,
        /// θ5 less its nominal value, as the running period of travel has it so far.
        running_5,
        /// θ6 less its nominal value, as the running period of travel has it so far.
        running_6,
        /// θ7 less its nominal value, as the running period of travel has it so far.
        running_7,
        /// θ8 less its nominal value, as the running period of travel has it so far.
        running_8,
        /// Gradient by θ9, gathered over the running period of travel.
        gathered_9,
        /// Periods of travel that the start has solved.
        start_periods,
        /// θ1 less its nominal value at the last end of some quiet periods of travel.
        recent_1,
        /// θ2 less its nominal value at the last end of some quiet periods of travel.
        recent_2,
        /// θ3 less its nominal value at the last end of some quiet periods of travel.
        recent_3,
        /// θ4 less its nominal value at the last end of some quiet periods of travel.
        recent_4,
        /// θ5 less its nominal value at the last end of some quiet periods of travel.
        recent_5,
        /// θ6 less its nominal value at the last end of some quiet periods of travel.
        recent_6,
        /// θ7 less its nominal value at the last end of some quiet periods of travel.
        recent_7,
        /// θ8 less its nominal value at the last end of some quiet periods of travel.
        recent_8,
        /// θ9 less its nominal value at the last end of some quiet periods of travel.
        recent_9,
        /// θ1 less its nominal value at the end before the one of recent_1.
        proven_1,
        /// θ2 less its nominal value at the end before the one of recent_2.
        proven_2,
        /// θ3 less its nominal value at the end before the one of recent_3.
        proven_3,
        /// θ4 less its nominal value at the end before the one of recent_4.
        proven_4,
        /// θ5 less its nominal value at the end before the one of recent_5.
        proven_5,
        /// θ6 less its nominal value at the end before the one of recent_6.
        proven_6,
        /// θ7 less its nominal value at the end before the one of recent_7.
        proven_7,
        /// θ8 less its nominal value at the end before the one of recent_8.
        proven_8,
        /// θ9 less its nominal value at the end before the one of recent_9.
        proven_9,
    } {
        /// The loop follows.
        locked,
        /// The lock was lost since the last zero preset or reset.
        lock_lost,
        /// Both corrected signals are too small.
        signal_lost,
        /// The scale runs backwards.
        direction,
        /// The sectors ahead of the origin were used right before the map was cleared.
        ahead_used,
        /// The sectors behind the origin were used right before the map was cleared.
        behind_used,
        /// The residual was large in this period of travel.
        disturbed,
        /// The residual was not small in this period of travel.
        rough,
        /// A gear of γ has ended with a small residual since the search began.
        calm,
        /// The radius was too large in this period of travel.
        risen,
        /// The residual was large in the period before: the parameters are held.
        held,
        /// The running period of travel has had an |e| larger than its γ gear expects of a sensor.
        astray,
        /// The period of travel before had one.
        astray_before,
        /// The two periods before had one, or more: it is not catching up.
        astray_long,
        /// Whole periods of travel follow one another fast enough for the completion.
        moving,
        /// What was recalled is held until some periods have passed quietly (recall).
        returning,
        /// The search began again where the residual had stayed: the signal may have faded (recall).
        fading,
        /// Parameters have been remembered in the last gear (recall).
        known,
        /// Half of the way to where they are remembered next (recall).
        halfway,
        /// A gain has moved away from what is proven.
        apart,
    }
}

bundle! {
    /// What arrives with a sample.
    Input {
        /// ADC code of the cosine channel, as a fraction of the ADC's range.
        adc_cos,
        /// ADC code of the sine channel, as a fraction of the ADC's range.
        adc_sin,
    } {
        /// Zero preset: this sample's period becomes number 0 and the lock-lost flag is cleared.
        preset,
        /// Calibration may update the parameters.
        calibrate,
    }
}

bundle! {
    /// Named internal signals of a sample, for waves and vectors.
    Probes {
        /// Normalised cosine channel.
        y_c,
        /// Normalised sine channel.
        y_s,
        /// θ1 as multiplied.
        theta_1,
        /// θ2 as multiplied.
        theta_2,
        /// θ3 as multiplied.
        theta_3,
        /// θ4 as multiplied.
        theta_4,
        /// θ5 as multiplied.
        theta_5,
        /// θ6 as multiplied.
        theta_6,
        /// θ7 as multiplied.
        theta_7,
        /// θ8 as applied to both channels.
        theta_8,
        /// θ9 as applied to the cosine, and with the other sign to the sine.
        theta_9,
        /// Corrected cosine.
        c,
        /// Corrected sine.
        s,
        /// Stored harmonics of the cosine at the estimate, as a fraction of the amplitude.
        harmonic_cos,
        /// Stored harmonics of the sine at the estimate, as a fraction of the amplitude.
        harmonic_sin,
        /// Phase by which the sine is sampled later than the cosine, radians.
        skew,
        /// cos α̂.
        cos_hat,
        /// sin α̂.
        sin_hat,
        /// Phase error, radians.
        e,
        /// Radial residual.
        rho,
        /// cos α̂ · ρ.
        rho_c,
        /// sin α̂ · ρ.
        rho_s,
        /// Position increment of this sample, turns: the speed.
        speed,
    } {
        /// Phase error and radius are as in lock.
        in_window,
        /// This sample may move the parameters.
        fresh,
        /// A whole period has been travelled since the map of sectors was cleared.
        whole_period,
    }
}
