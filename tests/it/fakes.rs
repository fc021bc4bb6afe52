//! Records with known content, and a workload whose tracers break on demand.

use rtbench::camera::View;
use rtbench::device::{DeviceInfo, DeviceType, FrameTime, Interrupted};
use rtbench::harness::environment;
use rtbench::math::Hit;
use rtbench::record::row::{Metric, SCHEMA, Samples, Settings, Status, TimingSource};
use rtbench::record::run::{DeviceRecord, Environment, PlanRecord, Provenance};
use rtbench::workloads::trace::backend::{Config, CountedPixel, Pixel, Prepared, Size, Timed, TraceRay};
use rtbench::workloads::trace::record::{
    ConfigurationRecord, CounterSums, Memory, SceneRecord, StructureRecord, WORKLOAD, by_ray_type,
};
use rtbench::workloads::trace::{Selection, Trace};
use rtbench::{Error, Result};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

pub fn provenance() -> Provenance {
    let info = DeviceInfo {
        name: "llvmpipe (LLVM 15.0.6, 256 bits)".into(),
        device_type: DeviceType::SoftwareRasteriser,
        backend: "vulkan".into(),
        driver: "Mesa 25.0.7".into(),
        timestamp_period_ns: Some(1.0),
        checked: false,
        features: vec!["TIMESTAMP_QUERY".into()],
        limits: [("max_buffer_size".to_owned(), u64::MAX)].into(),
        threads: Some(2),
    };
    Provenance {
        schema: SCHEMA.into(),
        id: "0123456789abcdef".into(),
        workload: WORKLOAD.into(),
        program: environment::program(),
        started: "2026-01-02T03:04:05Z".into(),
        arguments: vec!["rtbench".into(), "sweep".into(), "--out=\"a b\"".into()],
        devices: vec![DeviceRecord { info, reason: "the only Vulkan adapter".into() }],
        environment: Environment { load_average: [0.1, 0.2, 0.3], ..Environment::default() },
        plan: PlanRecord {
            preset: "quick".into(),
            axes: [("scene".to_owned(), vec!["scan".to_owned()])].into(),
            rows: 2,
            settings: Settings { passes: 2, warmup_frames: 1, builds: 1, threads: 0 },
            ..PlanRecord::default()
        },
        merged: Vec::new(),
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
        memory: Memory { structure_bytes: 100, geometry_bytes: 200, thesis_bytes: 300, rt2_bytes: 400 },
        ..StructureRecord::default()
    };
    (record.properties.cells_x, record.properties.references_per_triangle) = (Some(3), Some(1.5));
    record
}

/// Two passes over two frames: 2 and 4 ms by the device's clock, 2.2 and 4.4 by the host's.
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
        counters: Some(by_ray_type([
            CounterSums {
                rays: 100,
                inner: 600,
                leaves: 150,
                tests: 10,
                pops: 1,
                restarts: 0,
                ..CounterSums::default()
            },
            CounterSums { rays: 50, inner: 1, leaves: 1, tests: 100, pops: 0, restarts: 0, ..CounterSums::default() },
            CounterSums::default(),
        ])),
        memory: Memory { structure_bytes: 100, geometry_bytes: 200, thesis_bytes: 300, rt2_bytes: 400 },
        build_ms: 1.25,
        build_threads: 1,
        timing_source: Some(TimingSource::Device),
        samples: Some(Samples {
            device_ns: Some(vec![ms(2.0, 4.0), ms(2.0, 4.0)]),
            wall_ns: vec![ms(2.2, 4.4), ms(2.2, 4.4)],
            pass_ns: vec![7_000_000, 7_000_000],
            ..Samples::default()
        }),
        ..ConfigurationRecord::new(config)
    }
}

/// A step of measuring a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    Prepare,
    Verify,
    Count,
    Pass,
    Recheck,
}

/// What a tracer does wrong.
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
    /// A step is refused: too large.
    TooLarge(Step),
    /// A step is refused: no such function.
    Unsupported(Step),
    /// The device reports an error in a step.
    Device(Step),
    /// Preparing fails while anything else is prepared.
    NoRoomBeside,
    /// The device is lost while timing PS, once.
    LostOnce,
}

impl Fault {
    fn check(self, step: Step) -> Result<()> {
        match self {
            Fault::TooLarge(at) if at == step => {
                Err(Error::too_large("the structure", "5 GiB are needed, the device has 1 GiB", "use a smaller scene"))
            }
            Fault::Unsupported(at) if at == step => Err(Error::unsupported("no such feature")),
            Fault::Device(at) if at == step => Err(Error::Device("the driver says no".into())),
            _ => Ok(()),
        }
    }
}

/// What faults share and tests look at.
#[derive(Default)]
pub struct Seen {
    /// The device has been lost.
    pub spent: AtomicBool,
    /// Number of tracers at the moment.
    prepared: AtomicUsize,
    /// Every path that was timed: the structure, and the number of frames.
    pub timed: Mutex<Vec<(String, usize)>>,
}

/// Ray tracing with a fault wherever the structure called `structure` is used.
pub fn faulty(fault: Fault, structure: &'static str, seen: Arc<Seen>) -> Trace {
    Trace {
        decorate: Some(Box::new(move |inner, selection: &Selection| {
            let fault = if selection.name() == structure { fault } else { Fault::None };
            fault.check(Step::Prepare)?;
            if fault == Fault::NoRoomBeside && seen.prepared.load(Ordering::Relaxed) > 0 {
                return Err(Error::Device("out of memory".into()));
            }
            seen.prepared.fetch_add(1, Ordering::Relaxed);
            Ok(Box::new(Faulty { inner, fault, structure: selection.name(), seen: seen.clone() }))
        })),
    }
}

struct Faulty<'a> {
    inner: Box<dyn Prepared + 'a>,
    fault: Fault,
    structure: &'static str,
    seen: Arc<Seen>,
}

impl Drop for Faulty<'_> {
    fn drop(&mut self) {
        self.seen.prepared.fetch_sub(1, Ordering::Relaxed);
    }
}

impl Prepared for Faulty<'_> {
    fn image(&mut self, config: Config, view: &View, size: Size) -> Result<Vec<Pixel>> {
        self.fault.check(Step::Verify)?;
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
        self.fault.check(Step::Count)?;
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
        self.fault.check(Step::Pass)?;
        if self.fault == Fault::LostOnce && config == Config::PS && !self.seen.spent.swap(true, Ordering::Relaxed) {
            return Err(Error::DeviceLost("the driver\nreset".into()));
        }
        self.seen.timed.lock().unwrap().push((self.structure.to_owned(), views.len()));
        self.inner.time_path(config, views, size, interrupted)
    }

    fn timed(&mut self) -> Result<Timed> {
        self.fault.check(Step::Recheck)?;
        let mut timed = self.inner.timed()?;
        if self.fault == Fault::TimedDiffers {
            timed.pixels[5].triangle ^= 1;
        }
        Ok(timed)
    }

    fn cast(&mut self, rays: &[TraceRay], any_before: Option<f32>) -> Result<Vec<Hit>> {
        self.inner.cast(rays, any_before)
    }

    fn allocated(&self) -> (u64, u64) {
        self.inner.allocated()
    }

    fn artifact_metrics(&self) -> Vec<Metric> {
        self.inner.artifact_metrics()
    }
}
