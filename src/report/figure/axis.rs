//! Axes: ranges, ticks and their labels, linear or logarithmic.

/// An axis. A position on it is a value, or the decimal logarithm of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// What the axis shows, with the unit.
    pub label: String,
    /// True if positions are logarithms.
    pub log: bool,
    /// The positions of its two ends.
    pub range: (f64, f64),
    /// The positions of the ticks.
    pub ticks: Vec<f64>,
}

/// An axis is logarithmic if the largest value is more than so many times the smallest.
const LOG_SPREAD: f64 = 12.0;

impl Axis {
    /// An axis for these values; a linear one begins at zero.
    pub fn of_values(label: &str, log: bool, values: impl IntoIterator<Item = f64>) -> Axis {
        let (low, high) = bounds(values);
        let log = log && low > 0.0;
        let label = if log { format!("{label}, log scale") } else { label.to_owned() };
        if log {
            let range = (low.log10() - 0.1, high.log10() + 0.1);
            return Axis { label, log, range, ticks: log_ticks(range) };
        }
        let high = if high > 0.0 { 1.06 * high } else { 1.0 };
        Axis { label, log, range: (0.0, high), ticks: linear_ticks(0.0, high) }
    }

    /// An axis for sizes (pixels, cells), with a tick at each if they are few.
    pub fn of_sizes(label: &str, sizes: impl IntoIterator<Item = f64>) -> Axis {
        let mut sizes: Vec<f64> = sizes.into_iter().collect();
        sizes.sort_by(f64::total_cmp);
        sizes.dedup();
        let (low, high) = bounds(sizes.iter().copied());
        let log = spreads(sizes.iter().copied());
        let margin = if log { 0.05 } else { 0.05 * (high - low).max(1.0) };
        let position = |value: f64| if log { value.log10() } else { value };
        let range = (position(low) - margin, position(high) + margin);
        let ticks = match (sizes.len(), log) {
            (..=6, false) => sizes,
            (_, true) => log_ticks(range),
            _ => linear_ticks(range.0, range.1),
        };
        Axis { label: if log { format!("{label}, log scale") } else { label.into() }, log, range, ticks }
    }

    /// The position of a value.
    pub fn position(&self, value: f64) -> f64 {
        if self.log { value.log10() } else { value }
    }

    /// Writes the label of a tick.
    pub fn write(&self, position: f64) -> String {
        let value = if self.log { 10f64.powf(position) } else { position };
        let text = if value >= 100.0 { format!("{value:.0}") } else { format!("{value:.4}") };
        // Four decimals are enough for a tick; trailing zeros are left out
        if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
    }
}

/// True if values spread so far that a linear axis would hide the small ones.
pub fn spreads(values: impl IntoIterator<Item = f64>) -> bool {
    let (low, high) = bounds(values);
    low > 0.0 && high / low > LOG_SPREAD
}

fn bounds(values: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.into_iter().fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
    if low.is_finite() { (low, high) } else { (0.0, 1.0) }
}

/// One, two and five times powers of ten within a range of logarithms; only the powers if there are many.
fn log_ticks((low, high): (f64, f64)) -> Vec<f64> {
    let steps: &[f64] = if high - low > 2.5 { &[1.0] } else { &[1.0, 2.0, 5.0] };
    let decades = (low.floor() as i32)..=(high.ceil() as i32);
    let all = decades.flat_map(|decade| steps.iter().map(move |step| step.log10() + f64::from(decade)));
    all.filter(|tick| (low..=high).contains(tick)).collect()
}

/// About five round values within a range.
fn linear_ticks(low: f64, high: f64) -> Vec<f64> {
    let rough = (high - low) / 5.0;
    let power = 10f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|s| s * power).find(|s| *s >= rough).unwrap_or(rough);
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last).map(|n| n as f64 * step).collect()
}
