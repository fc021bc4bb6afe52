//! The bars of the sphere tracer's renderers, as ratios of interleaved rounds in one run:
//! `cargo bench --bench spheres_bars`. It ends with an error where one is missed.
//!
//! That of two threads is judged in a run in which two processes of one thread each do 1.9 times the work of one in the
//! same time; the processes are this program with `--control=FRAMES`. The scalar renderer is compared with
//! `spheres_cpp/tracer.cpp`, built here by g++ where there is one, and the GPU's with threads where there is a Vulkan
//! device.

mod common;

use common::{median, ratio};
use rtbench::device::VulkanDevice;
use rtbench::device::vulkan::{Selector, VulkanOptions, adapters, choose};
use rtbench::workloads::size::Size;
use rtbench::workloads::spheres::gpu::GpuRenderer;
use rtbench::workloads::spheres::options::{Algorithm, HitRecord, Lanes, Options, Renderer};
use rtbench::workloads::spheres::render::CpuRenderer;
use rtbench::workloads::spheres::render::compare::compare;
use rtbench::workloads::spheres::scene::{PackedSphere, Scene};
use rtbench::workloads::spheres::view::View;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Instant;

/// Milliseconds of one frame.
type Contestant<'a> = (String, Box<dyn FnMut() -> f64 + 'a>);

const BEST: Options = Options {
    algorithm: Algorithm::OnePass,
    exit_on_miss: true,
    skip_no_hit: true,
    skip_no_discriminant: true,
    hit: HitRecord::Index,
};

const SIMD8: Renderer = Renderer::Simd(Lanes::Eight, None);

/// What is rendered, and how often.
struct Setting {
    scene: Scene,
    spheres: Vec<PackedSphere>,
    size: Size,
    rounds: usize,
}

impl Setting {
    fn view(&self, trips: u32) -> View {
        View::of(&self.scene, self.size, trips, 0, 1)
    }
}

fn main() {
    let measuring = common::measuring();
    let scene = Scene::load("random100").expect("a scene of the program");
    let spheres = scene.packed();
    let setting = match measuring {
        true => Setting { scene, spheres, size: Size { width: 480, height: 270 }, rounds: 15 },
        false => Setting { scene, spheres, size: Size { width: 16, height: 9 }, rounds: 3 },
    };
    if let Some(frames) = std::env::args().find_map(|arg| arg.strip_prefix("--control=")?.parse().ok()) {
        return control(&setting, frames);
    }
    let pool = common::pool(0);
    let mut met = true;
    for (trips, bar) in [(5, 3.5), (1, 6.0)] {
        met &= vectors(&setting, trips, bar, &pool);
    }
    met &= threads(&setting, &pool, if measuring { 10 } else { 1 });
    met &= cpp(&setting, &pool);
    let large = if measuring { Size { width: 640, height: 360 } } else { setting.size };
    met &= gpu(&Setting { size: large, ..setting }, &pool);
    if measuring && !met {
        std::process::exit(1);
    }
}

fn contestant<'a>(
    name: &str,
    renderer: Renderer,
    options: Options,
    setting: &'a Setting,
    trips: u32,
    pool: &'a rayon::ThreadPool,
) -> Contestant<'a> {
    let view = setting.view(trips);
    let renderer = CpuRenderer::new(renderer, options, pool).expect("a renderer");
    let mut image = vec![[0.0; 4]; (view.width * view.height) as usize];
    let run = move || {
        let start = Instant::now();
        renderer.render(&setting.spheres, &view, &mut image);
        start.elapsed().as_secs_f64() * 1e3
    };
    (name.to_owned(), Box::new(run))
}

fn times(contestants: &mut [Contestant], rounds: usize) -> Vec<Vec<f64>> {
    let mut runs: Vec<&mut dyn FnMut() -> f64> = contestants.iter_mut().map(|c| &mut *c.1 as _).collect();
    let times = common::interleaved(&mut runs, rounds);
    for ((name, _), times) in contestants.iter().zip(&times) {
        println!("  {name:34} median {:8.3} ms", median(times));
    }
    times
}

/// Prints a ratio with its bar; true where it is met.
fn judge(what: &str, above: &[f64], below: &[f64], met: impl Fn(f64) -> bool, bar: &str) -> bool {
    let ratio = ratio(above, below);
    let met = met(ratio.value);
    let verdict = if met { "met" } else { "MISSED" };
    println!("  {what}: {:.3} ({:.3} to {:.3}), bar: {bar}: {verdict}", ratio.value, ratio.low, ratio.high);
    met
}

/// One thread, several pixels at once, against one thread and one pixel.
fn vectors(setting: &Setting, trips: u32, bar: f64, pool: &rayon::ThreadPool) -> bool {
    let (Size { width, height }, rounds) = (setting.size, setting.rounds);
    println!("{} spheres, {width} x {height}, {trips} trips, {rounds} interleaved rounds", setting.spheres.len());
    let paper = |algorithm, exits| Options {
        algorithm,
        exit_on_miss: algorithm == Algorithm::OnePass,
        skip_no_hit: exits,
        skip_no_discriminant: exits,
        hit: HitRecord::InLoop,
    };
    let simd4 = Renderer::Simd(Lanes::Four, None);
    let one = |name: &str, renderer, options| contestant(name, renderer, options, setting, trips, pool);
    let mut contestants = [
        one("sequential", Renderer::Sequential, BEST),
        one("simd, 8 lanes", SIMD8, BEST),
        one("simd, 4 lanes", simd4, BEST),
        one("simd, 16 lanes", Renderer::Simd(Lanes::Sixteen, None), BEST),
        one("sequential, two-pass", Renderer::Sequential, paper(Algorithm::TwoPass, false)),
        one("simd, 4 lanes, two-pass", simd4, paper(Algorithm::TwoPass, false)),
        one("sequential, one-pass", Renderer::Sequential, paper(Algorithm::OnePass, false)),
        one("simd, 4 lanes, one-pass", simd4, paper(Algorithm::OnePass, false)),
        one("simd, 4 lanes, one-pass, exits", simd4, paper(Algorithm::OnePass, true)),
    ];
    let times = times(&mut contestants, rounds);
    judge("sequential / simd, 8 lanes", &times[0], &times[1], |r| r >= bar, &format!("at least {bar}"))
}

/// Several threads against one, in a run that shows that there are processors for them.
fn threads(setting: &Setting, pool: &rayon::ThreadPool, tries: usize) -> bool {
    let count = pool.current_num_threads();
    if count != 2 {
        println!("simd-threads: not judged, the bar is for 2 threads and there are {count}");
        return true;
    }
    println!(
        "simd-threads on 2 threads against simd on one: judged in the first try in which two processes of one thread \
         each do at least 1.9 times the work of one in the same time"
    );
    for number in 1..=tries {
        println!("threads, try {number} of at most {tries}");
        let simd_threads = Renderer::SimdThreads(Lanes::Eight, None, 0);
        let mut contestants = [
            contestant("simd, 8 lanes", SIMD8, BEST, setting, 5, pool),
            contestant("simd-threads, 8 lanes", simd_threads, BEST, setting, 5, pool),
            ("control: one process".to_owned(), Box::new(|| at_once(1)) as _),
            ("control: two processes at once".to_owned(), Box::new(|| at_once(2)) as _),
        ];
        let times = times(&mut contestants, setting.rounds);
        let doubled: Vec<f64> = times[2].iter().map(|time| time * 2.0).collect();
        let quiet = judge("control: rate of two / of one", &doubled, &times[3], |r| r >= 1.9, "at least 1.9");
        let met = judge("simd / simd-threads", &times[0], &times[1], |r| r >= 1.8, "at least 1.8, where quiet");
        if quiet {
            println!("  simd-threads: judged, in this try");
            return met;
        }
    }
    println!("simd-threads: not judged, the machine was never quiet");
    true
}

/// A process of the control that waits for its start.
struct Waiting {
    child: Child,
    start: ChildStdin,
    end: BufReader<ChildStdout>,
}

impl Waiting {
    fn new() -> Waiting {
        let mut command = Command::new(std::env::current_exe().expect("a path of this program"));
        let (frames, measuring) = if common::measuring() { (20, Some("--bench")) } else { (1, None) };
        command.arg(format!("--control={frames}")).args(measuring);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("a process");
        let start = child.stdin.take().expect("a pipe");
        let mut waiting = Waiting { start, end: BufReader::new(child.stdout.take().expect("a pipe")), child };
        waiting.line("ready");
        waiting
    }

    /// Waits for a line of the process.
    fn line(&mut self, expected: &str) {
        let mut line = String::new();
        self.end.read_line(&mut line).expect("a line of the control");
        assert_eq!(line.trim(), expected, "the control failed");
    }
}

/// Milliseconds until `count` processes have each rendered their frames; how long they take to start is left out.
fn at_once(count: usize) -> f64 {
    let mut processes: Vec<Waiting> = (0..count).map(|_| Waiting::new()).collect();
    let start = Instant::now();
    processes.iter_mut().for_each(|process| process.start.write_all(b"!").expect("a process that reads"));
    processes.iter_mut().for_each(|process| process.line("done"));
    let time = start.elapsed().as_secs_f64() * 1e3;
    for mut process in processes {
        assert!(process.child.wait().expect("an end").success(), "the control failed");
    }
    time
}

/// The control's process: after a first frame it waits for a byte, then it renders so many frames on its one thread.
fn control(setting: &Setting, frames: usize) {
    let pool = common::pool(1);
    let (_, mut frame) = contestant("control", SIMD8, BEST, setting, 5, &pool);
    frame();
    println!("ready");
    std::io::stdin().read_exact(&mut [0]).expect("a byte");
    for _ in 0..frames {
        frame();
    }
    println!("done");
}

/// The GPU's renderer against threads; true without a Vulkan device, too.
fn gpu(setting: &Setting, pool: &rayon::ThreadPool) -> bool {
    let adapters = adapters();
    let best = choose(&adapters, &Selector::Best);
    let device = match best.and_then(|best| VulkanDevice::open(best, VulkanOptions::default())) {
        Ok(device) => device,
        Err(error) => {
            println!("gpu: not judged, there is no Vulkan device ({error})");
            return true;
        }
    };
    let Size { width, height } = setting.size;
    println!("gpu on {} against threads, {width} x {height}, 5 trips: frame times are judged", device.info().name);
    let view = setting.view(5);
    let renderer = GpuRenderer::new(&device, &setting.spheres, BEST, setting.size, 5).expect("a renderer");
    let frame = || {
        let times = renderer.time(&[view], &|| false).expect("a frame");
        times[0].wall_ns as f64 / 1e6
    };
    let mut contestants = [
        contestant("threads", Renderer::Threads(0), BEST, setting, 5, pool),
        ("gpu".to_owned(), Box::new(frame) as Box<dyn FnMut() -> f64>),
    ];
    let times = times(&mut contestants, setting.rounds);
    judge("gpu / threads", &times[1], &times[0], |r| r <= 2.0, "at most 2")
}

/// The scalar renderer against C++; true without g++, too.
fn cpp(setting: &Setting, pool: &rayon::ThreadPool) -> bool {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let Some(programs) = ["-O2", "-O3"].map(|level| compiled(level, folder.path())).into_iter().collect() else {
        println!("C++: not judged, there is no g++");
        return true;
    };
    let programs: Vec<PathBuf> = programs;
    println!("scalar, one-pass, {} x {}, 5 trips", setting.size.width, setting.size.height);
    let view = setting.view(5);
    let mut own = vec![[0.0; 4]; (view.width * view.height) as usize];
    let sequential = CpuRenderer::new(Renderer::Sequential, BEST, pool).expect("a renderer");
    sequential.render(&setting.spheres, &view, &mut own);
    for program in &programs {
        let (picture, _) = ran(program, setting, &view);
        assert_eq!(compare(&own, &picture, view.width as usize), None, "the C++ picture is another one");
    }
    let mut contestants = vec![contestant("sequential", Renderer::Sequential, BEST, setting, 5, pool)];
    for (program, level) in programs.iter().zip(["-O2", "-O3"]) {
        contestants.push((format!("g++ {level}"), Box::new(move || ran(program, setting, &view).1)));
    }
    let times = times(&mut contestants, setting.rounds);
    let faster = if median(&times[1]) < median(&times[2]) { 1 } else { 2 };
    let what = format!("sequential / {}", contestants[faster].0);
    judge(&what, &times[0], &times[faster], |r| r <= 1.10, "at most 1.10")
}

/// The C++ program, if there is a compiler.
fn compiled(level: &str, folder: &Path) -> Option<PathBuf> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/spheres_cpp/tracer.cpp");
    let program = folder.join(format!("tracer{level}"));
    let mut compiler = Command::new("g++");
    compiler.args(["-std=c++17", level, "-ffp-contract=off", "-o"]).arg(&program).arg(source);
    let status = compiler.status().ok()?;
    assert!(status.success(), "g++ cannot build tracer.cpp");
    Some(program)
}

/// The picture, and the milliseconds of the second of two frames of one process.
fn ran(program: &Path, setting: &Setting, view: &View) -> (Vec<[f32; 4]>, f64) {
    let mut input = Vec::new();
    for number in [2, view.width, view.height, view.trips, view.spheres] {
        input.extend(number.to_ne_bytes());
    }
    input.extend(&bytemuck::bytes_of(view)[..27 * 4]);
    input.extend(bytemuck::cast_slice::<_, u8>(&setting.spheres));
    let mut command = Command::new(program);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("a process");
    child.stdin.take().expect("a pipe").write_all(&input).expect("the program reads all");
    let output = child.wait_with_output().expect("an end");
    assert!(output.status.success(), "the C++ program failed");
    let times = String::from_utf8(output.stderr).expect("numbers");
    let time = times.lines().last().and_then(|line| line.parse().ok()).expect("a time");
    (bytemuck::pod_collect_to_vec(&output.stdout), time)
}
