//! Records with known content, and a device that can be told to break.

use rtbench::camera::View;
use rtbench::harness::environment;
use rtbench::math::Hit;
use rtbench::record::schema::{
    ConfigurationRecord, CounterSums, Environment, Memory, PlanRecord, Provenance, SCHEMA, Samples, SceneRecord,
    Status, StructureRecord, TimingSource,
};
use rtbench::scene::Scene;
use rtbench::workloads::trace::CpuBackend;
use rtbench::workloads::trace::backend::{
    Backend, Config, CountedPixel, DeviceInfo, DeviceType, FrameTime, GivenRay, Interrupted, Pixel, Prepared, Size,
    Timed,
};
use rtbench::workloads::trace::{Method, Structure, Traversal};
use rtbench::{Error, Result};
use std::cell::{Cell, RefCell};
use std::rc::Rc;

pub fn provenance() -> Provenance {
    Provenance {
        schema: SCHEMA.into(),
        program: environment::program(),
        started: "2026-01-02T03:04:05Z".into(),
        arguments: vec!["rtbench".into(), "sweep".into(), "--out=\"a b\"".into()],
        device: DeviceInfo {
            name: "llvmpipe (LLVM 15.0.6, 256 bits)".into(),
            device_type: DeviceType::SoftwareRasteriser,
            backend: "vulkan".into(),
            driver: "Mesa 25.0.7".into(),
            timestamp_period_ns: Some(1.0),
            checked: false,
            features: vec!["TIMESTAMP_QUERY".into()],
            limits: [("max_buffer_size".to_owned(), u64::MAX)].into(),
            threads: Some(2),
        },
        device_reason: "the only Vulkan adapter".into(),
        environment: Environment { load_average: [0.1, 0.2, 0.3], ..Environment::default() },
        plan: PlanRecord {
            preset: "quick".into(),
            scenes: vec!["scan".into()],
            structures: vec!["grid (default)".into()],
            configurations: 2,
            passes: 2,
            warmup_frames: 1,
            builds: 1,
            skipped: vec![],
        },
    }
}

fn scene() -> SceneRecord {
    SceneRecord { name: "scan".into(), hash: "abc".into(), triangles: 12, vertices: 8, ..SceneRecord::default() }
}

pub fn structure(name: &str) -> StructureRecord {
    let mut record = StructureRecord {
        scene: scene(),
        structure: name.into(),
        variant: "default".into(),
        build_ms: 1.25,
        build_threads: 1,
        memory: Memory { structure_bytes: 100, geometry_bytes: 200, thesis_bytes: 300 },
        ..StructureRecord::default()
    };
    (record.properties.cells_x, record.properties.references_per_triangle) = (Some(3), Some(1.5));
    record
}

/// Two passes over two frames: 2 and 4 ms by the device's clock, 2.2 and 4.4 by the wall's.
pub fn configuration(name: &str, config: Config) -> ConfigurationRecord {
    let ms = |a: f64, b: f64| vec![(a * 1e6) as u64, (b * 1e6) as u64];
    ConfigurationRecord {
        scene: scene(),
        structure: name.into(),
        variant: "default".into(),
        width: 10,
        height: 5,
        frames: 2,
        passes: 2,
        status: Status::Ok,
        verified: true,
        image_hash: Some("123".into()),
        counters: Some([
            CounterSums { rays: 100, inner: 600, leaves: 150, tests: 10, pops: 1, restarts: 0 },
            CounterSums { rays: 50, inner: 1, leaves: 1, tests: 100, pops: 0, restarts: 0 },
            CounterSums::default(),
        ]),
        memory: Memory { structure_bytes: 100, geometry_bytes: 200, thesis_bytes: 300 },
        build_ms: 1.25,
        build_threads: 1,
        timing_source: Some(TimingSource::Device),
        samples: Some(Samples {
            device_ns: Some(vec![ms(2.0, 4.0), ms(2.0, 4.0)]),
            wall_ns: vec![ms(2.2, 4.4), ms(2.2, 4.4)],
            pass_ns: vec![7_000_000, 7_000_000],
        }),
        ..ConfigurationRecord::new(config)
    }
}

/// What a device does wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// Nothing.
    None,
    /// One pixel of the timed kernel names another triangle.
    WrongTriangle,
    /// One pixel of the counting kernel has another colour.
    CountingDiffers,
    /// One pixel of the last timed frame names another triangle.
    TimedDiffers,
    /// Preparing fails: too large.
    NoRoom,
    /// Preparing fails while anything else is prepared.
    NoRoomBeside,
    /// Lost while timing PS, once.
    LostOnce,
}

/// The CPU twins, with a fault wherever `traversal` is walked.
pub struct Faulty {
    inner: CpuBackend,
    info: DeviceInfo,
    fault: Fault,
    traversal: Traversal,
    spent: Rc<Cell<bool>>,
    /// What is prepared at the moment.
    prepared: Cell<usize>,
    /// Every path that was timed: the traversal, and the number of frames.
    timed: Rc<RefCell<Vec<(Traversal, usize)>>>,
}

impl Faulty {
    pub fn new(fault: Fault, traversal: Traversal, spent: Rc<Cell<bool>>) -> Faulty {
        let inner = CpuBackend::new(1).unwrap();
        let info = inner.info().clone();
        Faulty { inner, info, fault, traversal, spent, prepared: Cell::new(0), timed: Rc::default() }
    }

    /// Writes down what is timed.
    pub fn watched(mut self, timed: Rc<RefCell<Vec<(Traversal, usize)>>>) -> Faulty {
        self.timed = timed;
        self
    }

    /// Under another name.
    pub fn named(mut self, name: &str) -> Faulty {
        self.info.name = name.into();
        self
    }
}

impl Backend for Faulty {
    fn info(&self) -> &DeviceInfo {
        &self.info
    }

    fn prepare<'a>(
        &'a self,
        scene: &'a Scene,
        structure: &'a Structure,
        method: Method,
    ) -> Result<Box<dyn Prepared + 'a>> {
        let fault = if method.traversal == self.traversal { self.fault } else { Fault::None };
        if fault == Fault::NoRoom {
            return Err(Error::Device("the structure needs 5 GiB, the device has 1 GiB".into()));
        }
        if fault == Fault::NoRoomBeside && self.prepared.get() > 0 {
            return Err(Error::Device("out of memory".into()));
        }
        let inner = self.inner.prepare(scene, structure, method)?;
        self.prepared.set(self.prepared.get() + 1);
        Ok(Box::new(FaultyPrepared { inner, fault, traversal: method.traversal, device: self }))
    }
}

struct FaultyPrepared<'a> {
    inner: Box<dyn Prepared + 'a>,
    fault: Fault,
    traversal: Traversal,
    device: &'a Faulty,
}

impl Drop for FaultyPrepared<'_> {
    fn drop(&mut self) {
        self.device.prepared.set(self.device.prepared.get() - 1);
    }
}

impl Prepared for FaultyPrepared<'_> {
    fn image(&mut self, config: Config, view: &View, size: Size) -> Result<Vec<Pixel>> {
        let mut pixels = self.inner.image(config, view, size)?;
        if self.fault == Fault::WrongTriangle {
            let middle = pixels.len() / 2;
            pixels[middle].triangle = pixels[middle].triangle.wrapping_add(1);
        }
        Ok(pixels)
    }

    fn counted(
        &mut self,
        config: Config,
        view: &View,
        size: Size,
        band: &mut dyn FnMut(u32, &[CountedPixel]),
    ) -> Result<()> {
        let differs = self.fault == Fault::CountingDiffers;
        self.inner.counted(config, view, size, &mut |row, pixels| {
            let mut pixels = pixels.to_vec();
            if differs && row == 0 {
                pixels[0].pixel.rgba ^= 1;
            }
            band(row, &pixels);
        })
    }

    fn time_path(
        &mut self,
        config: Config,
        views: &[View],
        size: Size,
        interrupted: Interrupted,
    ) -> Result<Vec<FrameTime>> {
        if self.fault == Fault::LostOnce && config == Config::PS && !self.device.spent.replace(true) {
            return Err(Error::DeviceLost("the driver\nreset".into()));
        }
        self.device.timed.borrow_mut().push((self.traversal, views.len()));
        self.inner.time_path(config, views, size, interrupted)
    }

    fn timed(&mut self) -> Result<Timed> {
        let mut timed = self.inner.timed()?;
        if self.fault == Fault::TimedDiffers {
            timed.pixels[5].triangle ^= 1;
        }
        Ok(timed)
    }

    fn trace(&mut self, rays: &[GivenRay], any_hit: bool) -> Result<Vec<Hit>> {
        self.inner.trace(rays, any_hit)
    }

    fn allocated(&self) -> (u64, u64) {
        self.inner.allocated()
    }
}
