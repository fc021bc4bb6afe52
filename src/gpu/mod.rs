//! stub
use crate::{Error, Result, accel::*, backend::*, scene::Scene};
/// stub
pub enum Selector {
    /// b
    Best,
    /// i
    Index(usize),
    /// n
    Name(String),
}
/// stub
#[derive(Clone, Copy, Default)]
pub struct Options {
    /// c
    pub checked: bool,
}
/// stub
pub struct GpuBackend(DeviceInfo);
/// stub
pub fn adapters() -> Vec<DeviceInfo> {
    vec![]
}
impl GpuBackend {
    /// stub
    pub fn open(_: &Selector, _: Options) -> Result<GpuBackend> {
        Err(Error::Device("no GPU".into()))
    }
}
impl Backend for GpuBackend {
    fn info(&self) -> &DeviceInfo {
        &self.0
    }
    fn prepare<'a>(&'a self, _: &'a Scene, _: &'a Structure, _: Traversal) -> Result<Box<dyn Prepared + 'a>> {
        Err(Error::Device("no GPU".into()))
    }
}
