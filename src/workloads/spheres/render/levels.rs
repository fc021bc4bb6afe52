//! Instruction sets: which of them there are, which of them this processor has.

use super::super::options::{Lanes, Level};
use super::probe::Probe;
use super::{Band, Job, simd};
use crate::error::{Error, Result};
#[cfg(target_arch = "aarch64")]
use fearless_simd::Neon;
#[cfg(target_arch = "x86_64")]
use fearless_simd::{Avx2, Avx512, Sse2};

/// The proof that this processor has a level.
#[derive(Clone, Copy)]
pub(super) enum Token {
    #[cfg(target_arch = "x86_64")]
    Sse2(Sse2),
    #[cfg(target_arch = "x86_64")]
    Avx2(Avx2),
    #[cfg(target_arch = "x86_64")]
    Avx512(Avx512),
    #[cfg(target_arch = "aarch64")]
    Neon(Neon),
}

impl Token {
    fn of(level: Level) -> Option<Token> {
        let detected = fearless_simd::Level::new();
        match level {
            #[cfg(target_arch = "x86_64")]
            Level::Sse2 => detected.as_sse2().map(Token::Sse2),
            #[cfg(target_arch = "x86_64")]
            Level::Avx2 => detected.as_avx2().map(Token::Avx2),
            #[cfg(target_arch = "x86_64")]
            Level::Avx512 => detected.as_avx512().map(Token::Avx512),
            #[cfg(target_arch = "aarch64")]
            Level::Neon => detected.as_neon().map(Token::Neon),
            _ => None,
        }
    }

    pub(super) fn level(self) -> Level {
        match self {
            #[cfg(target_arch = "x86_64")]
            Token::Sse2(_) => Level::Sse2,
            #[cfg(target_arch = "x86_64")]
            Token::Avx2(_) => Level::Avx2,
            #[cfg(target_arch = "x86_64")]
            Token::Avx512(_) => Level::Avx512,
            #[cfg(target_arch = "aarch64")]
            Token::Neon(_) => Level::Neon,
        }
    }

    /// Renders a band with exactly this level's instructions, though the processor may have better ones.
    pub(super) fn rows<P: Probe>(self, lanes: Lanes, job: &Job, band: Band, probe: &mut P) {
        match self {
            #[cfg(target_arch = "x86_64")]
            Token::Sse2(token) => simd::rows(token, lanes, job, band, probe),
            #[cfg(target_arch = "x86_64")]
            Token::Avx2(token) => simd::rows(token, lanes, job, band, probe),
            #[cfg(target_arch = "x86_64")]
            Token::Avx512(token) => simd::rows(token, lanes, job, band, probe),
            #[cfg(target_arch = "aarch64")]
            Token::Neon(token) => simd::rows(token, lanes, job, band, probe),
        }
    }
}

/// The levels of this processor, the least first.
pub fn levels() -> Vec<Level> {
    Level::ALL.iter().map(|(_, level)| *level).filter(|&level| Token::of(level).is_some()).collect()
}

/// The best one; none on a processor without any of them.
pub fn best_level() -> Option<Level> {
    levels().pop()
}

/// The proof for a level, or for the best one.
///
/// # Errors
/// Refused if this processor lacks it; the message names the level and those that there are.
pub(super) fn token(level: Option<Level>) -> Result<Token> {
    level.or_else(best_level).and_then(Token::of).ok_or_else(|| {
        let present: Vec<&str> = levels().into_iter().map(Level::name).collect();
        let present = if present.is_empty() { "none".to_owned() } else { present.join(", ") };
        let wanted = level.map_or("any", Level::name);
        let untested = if level == Some(Level::Neon) { "; this level is untested" } else { "" };
        Error::unsupported(format!("level {wanted}: this {} processor has {present}{untested}", std::env::consts::ARCH))
    })
}

/// Architecture and vector instructions that scalar code was compiled for, `x86_64 sse2`.
pub(super) fn compiled() -> String {
    let sets = [
        (cfg!(target_feature = "avx512f"), "avx512"),
        (cfg!(target_feature = "avx2"), "avx2"),
        (cfg!(target_feature = "sse4.2"), "sse4.2"),
        (cfg!(target_feature = "sse2"), "sse2"),
        (cfg!(target_feature = "neon"), "neon"),
    ];
    let best = sets.iter().find(|set| set.0).map_or("scalar", |set| set.1);
    format!("{} {best}", std::env::consts::ARCH)
}
