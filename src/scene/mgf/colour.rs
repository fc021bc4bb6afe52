//! CIE chromaticities, from coordinates, spectra and black bodies.

use glam::{DMat3, DVec3};
use std::sync::LazyLock;

/// CIE 1931 chromaticity coordinates (x, y). The default is the equal-energy point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chromaticity {
    x: f64,
    y: f64,
}

impl Default for Chromaticity {
    fn default() -> Chromaticity {
        Chromaticity { x: 1.0 / 3.0, y: 1.0 / 3.0 }
    }
}

/// The conversion from CIE XYZ to linear Rec. 709 (sRGB).
const RGB: DMat3 = DMat3::from_cols_array_2d(&[
    [3.240_97, -0.969_244, 0.055_630_1],
    [-1.537_383, 1.875_968, -0.203_977],
    [-0.498_611, 0.041_555, 1.056_972],
]);

/// Weights of linear red, green and blue in the luminance (Rec. 709).
const LUMINANCE: DVec3 = DVec3::new(0.2126, 0.7152, 0.0722);

impl Chromaticity {
    /// The chromaticity with these coordinates, if they are valid. Both may be zero, which is a saturated blue: the
    /// third coordinate is then 1.
    pub fn new(x: f64, y: f64) -> Option<Chromaticity> {
        (x >= 0.0 && y >= 0.0 && x + y <= 1.0 + 1e-6).then_some(Chromaticity { x, y })
    }

    fn of_xyz(xyz: DVec3) -> Option<Chromaticity> {
        let sum = xyz.element_sum();
        (sum > 0.0 && sum.is_finite()).then(|| Chromaticity { x: xyz.x / sum, y: xyz.y / sum })
    }

    /// The colour in XYZ with luminance 1.
    fn xyz(self) -> DVec3 {
        // y is limited from below, because colours with y = 0 have no luminance.
        let y = self.y.max(1e-3);
        DVec3::new(self.x / y, 1.0, (1.0 - self.x - self.y).max(0.0) / y)
    }

    /// The colour in linear Rec. 709 with luminance 1; out-of-gamut colours are clipped. The equal-energy point is
    /// white.
    pub fn rgb(self) -> DVec3 {
        let rgb = (RGB * self.xyz() / (RGB * DVec3::ONE)).max(DVec3::ZERO);
        rgb / rgb.dot(LUMINANCE).max(1e-6)
    }

    /// The mixture of colours, weighted by luminance.
    pub fn mix(parts: &[(f64, Chromaticity)]) -> Option<Chromaticity> {
        Chromaticity::of_xyz(parts.iter().fold(DVec3::ZERO, |sum, (weight, colour)| sum + colour.xyz() * *weight))
    }

    /// The chromaticity of a spectrum: values at evenly spaced wavelengths (nm) from `from` to `to`, zero outside.
    pub fn spectrum(from: f64, to: f64, values: &[f64]) -> Option<Chromaticity> {
        if values.len() < 2 || to <= from {
            return None;
        }
        integrate(|wavelength| {
            let place = (wavelength - from) / (to - from) * (values.len() - 1) as f64;
            if !(0.0..=(values.len() - 1) as f64).contains(&place) {
                return 0.0;
            }
            let below = (place as usize).min(values.len() - 2);
            let share = place - below as f64;
            values[below] * (1.0 - share) + values[below + 1] * share
        })
    }

    /// The chromaticity of a black body at a temperature in kelvin (Planck's law).
    pub fn black_body(kelvin: f64) -> Option<Chromaticity> {
        if kelvin <= 0.0 {
            return None;
        }
        // The second radiation constant in nm K. Values are relative to 560 nm, so that cold bodies do not underflow.
        let exponent = |wavelength: f64| 1.438_777e7 / (wavelength * kelvin);
        let scale = exponent(560.0);
        let whole = 1.0 - (-scale).exp();
        integrate(|wavelength| {
            let x = exponent(wavelength);
            (560.0 / wavelength).powi(5) * (scale - x).exp() * whole / (1.0 - (-x).exp())
        })
    }
}

/// Number of wavelengths at which a spectrum is sampled.
pub const SAMPLES: usize = 81;

/// The sampled wavelengths with the CIE's colour matching functions, as sums of Gaussian lobes (Wyman, Sloan and
/// Shirley 2013). They are computed once, because a file may have a spectrum in every line.
static MATCHING: LazyLock<[(f64, DVec3); SAMPLES]> = LazyLock::new(|| {
    let lobe = |wavelength: f64, center: f64, below: f64, above: f64| {
        let t = (wavelength - center) * if wavelength < center { below } else { above };
        (-0.5 * t * t).exp()
    };
    std::array::from_fn(|i| {
        let w = 380.0 + 5.0 * i as f64;
        let x = 1.056 * lobe(w, 599.8, 0.0264, 0.0323) + 0.362 * lobe(w, 442.0, 0.0624, 0.0374)
            - 0.065 * lobe(w, 501.1, 0.0490, 0.0382);
        let y = 0.821 * lobe(w, 568.8, 0.0213, 0.0247) + 0.286 * lobe(w, 530.9, 0.0613, 0.0322);
        let z = 1.217 * lobe(w, 437.0, 0.0845, 0.0278) + 0.681 * lobe(w, 459.0, 0.0385, 0.0725);
        (w, DVec3::new(x, y, z))
    })
});

/// The chromaticity of a spectral power distribution.
fn integrate(spectrum: impl Fn(f64) -> f64) -> Option<Chromaticity> {
    let matching = MATCHING.iter();
    Chromaticity::of_xyz(matching.fold(DVec3::ZERO, |sum, &(wavelength, xyz)| sum + xyz * spectrum(wavelength)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: Option<Chromaticity>, x: f64, y: f64) {
        let found = found.unwrap();
        assert!((found.x - x).abs() < 0.006 && (found.y - y).abs() < 0.006, "{found:?}, not ({x}, {y})");
    }

    #[test]
    fn spectra_have_the_chromaticities_of_the_tables() {
        near(Chromaticity::spectrum(380.0, 780.0, &[1.0, 1.0]), 1.0 / 3.0, 1.0 / 3.0);
        near(Chromaticity::black_body(2856.0), 0.4476, 0.4074); // illuminant A
        near(Chromaticity::black_body(6500.0), 0.3135, 0.3237);
        near(Chromaticity::black_body(1.0e9), 0.2399, 0.2341); // the end of the Planckian locus
        near(Chromaticity::spectrum(590.0, 610.0, &[0.0, 1.0, 0.0]), 0.6270, 0.3725); // 600 nm
        assert_eq!(Chromaticity::spectrum(500.0, 400.0, &[1.0, 1.0]), None);
        assert_eq!(Chromaticity::black_body(0.0), None);
    }

    #[test]
    fn equal_energy_is_white_and_mixtures_are_weighted_by_luminance() {
        assert!(Chromaticity::default().rgb().abs_diff_eq(DVec3::ONE, 1e-3));
        let red = Chromaticity::new(0.64, 0.33).unwrap();
        let rgb = red.rgb();
        assert!(rgb.x > 4.0 && rgb.y < 0.2 && rgb.z < 0.2, "{rgb}");
        assert!((rgb.dot(LUMINANCE) - 1.0).abs() < 1e-9);
        assert_eq!(Chromaticity::mix(&[(3.0, red)]).map(|c| (c.x * 1e6).round()), Some(640_000.0));
        assert_eq!(Chromaticity::mix(&[(0.0, red)]), None);
        assert_eq!(Chromaticity::new(0.8, 0.3), None);
        assert_eq!(Chromaticity::new(f64::NAN, 0.3), None);
        let blue = Chromaticity::new(0.0, 0.0).unwrap().rgb();
        assert!(blue.is_finite() && blue.z > 5.0 && blue.x == 0.0 && blue.y < 1.0, "{blue}");
    }
}
