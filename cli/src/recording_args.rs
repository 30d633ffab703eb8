//! What a recording does not say about itself: the same flags on every command that reads one.

use clap::Args;
use nonius_recording::Overrides;

/// Flags that describe a recording.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "What the recording does not say")]
pub(crate) struct RecordingArgs {
    /// Samples per second; `time_s` wins over it.
    #[arg(long, value_name = "HZ")]
    sample_rate: Option<f64>,
    /// Bits of the ADC, 2 to 32.
    #[arg(long, value_name = "BITS")]
    adc_bits: Option<u32>,
    /// The ADC spans −X … +X in the unit of the columns.
    #[arg(long, value_name = "X")]
    full_scale: Option<f64>,
    /// Scale periods in one revolution.
    #[arg(long, value_name = "N")]
    periods_per_revolution: Option<u32>,
    /// Name of the column to read in place of `cos`.
    #[arg(long, value_name = "COLUMN")]
    cos: Option<String>,
    /// Name of the column to read in place of `sin`.
    #[arg(long, value_name = "COLUMN")]
    sin: Option<String>,
    /// Name of the column to read in place of `time_s`, in the unit that it says: `Time (ms)`.
    #[arg(long, value_name = "COLUMN")]
    time: Option<String>,
}

impl RecordingArgs {
    /// For the reader.
    pub(crate) fn overrides(&self) -> Overrides {
        Overrides {
            sample_rate_hz: self.sample_rate,
            adc_bits: self.adc_bits,
            full_scale: self.full_scale,
            periods_per_revolution: self.periods_per_revolution,
            cos_column: self.cos.clone(),
            sin_column: self.sin.clone(),
            time_column: self.time.clone(),
        }
    }
}
