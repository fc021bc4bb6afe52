//! Vectors of three registers, one for each axis: the lanes of a register are different pixels.

use std::ops::{Add, Div, Mul, Sub};

/// What the arithmetic of one register needs. Additions stay where they are written: nothing here fuses or reorders.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {}

impl<F: Copy + Add<Output = F> + Sub<Output = F> + Mul<Output = F> + Div<Output = F>> Number for F {}

/// Three registers.
#[derive(Clone, Copy, Debug)]
pub struct V3<F> {
    /// First axis, or red.
    pub x: F,
    /// Second axis, or green.
    pub y: F,
    /// Third axis, or blue.
    pub z: F,
}

impl<F: Number> V3<F> {
    /// The same operation on each axis.
    #[inline(always)]
    pub fn map(self, f: impl Fn(F) -> F) -> V3<F> {
        V3 { x: f(self.x), y: f(self.y), z: f(self.z) }
    }

    /// The same operation on each axis of two vectors.
    #[inline(always)]
    pub fn zip(self, other: V3<F>, f: impl Fn(F, F) -> F) -> V3<F> {
        V3 { x: f(self.x, other.x), y: f(self.y, other.y), z: f(self.z, other.z) }
    }

    /// (xx + yy) + zz.
    #[inline(always)]
    pub fn dot(self, other: V3<F>) -> F {
        (self.x * other.x + self.y * other.y) + self.z * other.z
    }
}

impl<F: Number> Add for V3<F> {
    type Output = V3<F>;
    #[inline(always)]
    fn add(self, other: V3<F>) -> V3<F> {
        self.zip(other, |a, b| a + b)
    }
}

impl<F: Number> Sub for V3<F> {
    type Output = V3<F>;
    #[inline(always)]
    fn sub(self, other: V3<F>) -> V3<F> {
        self.zip(other, |a, b| a - b)
    }
}

/// By component.
impl<F: Number> Mul for V3<F> {
    type Output = V3<F>;
    #[inline(always)]
    fn mul(self, other: V3<F>) -> V3<F> {
        self.zip(other, |a, b| a * b)
    }
}

impl<F: Number> Mul<F> for V3<F> {
    type Output = V3<F>;
    #[inline(always)]
    fn mul(self, factor: F) -> V3<F> {
        self.map(|a| a * factor)
    }
}

/// Three divisions: a product with the reciprocal is another number.
impl<F: Number> Div<F> for V3<F> {
    type Output = V3<F>;
    #[inline(always)]
    fn div(self, divisor: F) -> V3<F> {
        self.map(|a| a / divisor)
    }
}
