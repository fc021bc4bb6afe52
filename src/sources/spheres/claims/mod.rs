//! The paper's claims, judged by frame times of one machine, and by pictures of half precision.

mod cases;
mod list;
mod pictures;

pub use pictures::{UNUSABLE_DB, half_pictures, psnr, single_of};

use super::data::{Data, Measurement, Place, Terms, View};
use super::metrics::{Parallel, quotient};
use super::published::Published;
use super::scenes::{Role, SceneKey};
use super::setting::{Renderer, Stage, Version};
use super::{DOCUMENT, SOURCE};
use crate::compare::judge::Uncertain;
use crate::sources::claims::{Case, Finding, Grounds, Statement};
use list::{About, CLAIMS, Claim};

/// Whose numbers a claim is put to.
pub struct Asked<'a> {
    /// The rows.
    pub view: View<'a>,
    /// Set if these are the printed ones.
    pub printed: Option<&'a Published>,
    /// Processors of the GPU.
    pub gpu_processors: Option<u32>,
}

/// All findings: by each machine, or by what was printed.
pub fn judge(data: Option<&Data>, published: &Published, gpu_processors: Option<u32>) -> Vec<Finding> {
    let place = published.data.places[0];
    let view = View { data: &published.data, place, terms: Terms::default() };
    let printed = Asked { view, printed: Some(published), gpu_processors: None };
    let Some(data) = data else {
        let finding = |claim: &Claim| {
            let cases = (claim.cases)(&printed);
            let warnings = Grounds::of(claim.basis, None, None, claim.remark).warnings;
            Finding { warnings, ..Finding::of(claim.statement(), claim.basis, cases, &[]) }
        };
        return CLAIMS.iter().map(finding).collect();
    };
    let mut places = data.places.clone();
    if places.is_empty() {
        places.push(Place { machine: 0, gpu: None });
    }
    let asked = places.iter().map(|place| Asked { view: data.main_view(*place, None), printed: None, gpu_processors });
    let asked: Vec<Asked> = asked.collect();
    CLAIMS.iter().flat_map(|claim| asked.iter().map(|asked| finding(claim, asked, &printed))).collect()
}

fn finding(claim: &Claim, asked: &Asked, printed: &Asked) -> Finding {
    let (data, place) = (asked.view.data, asked.view.place);
    let cpu = data.devices.get(place.machine);
    let gpu = place.gpu.and_then(|gpu| data.devices.get(gpu));
    let device = if claim.about == About::Gpu { gpu } else { cpu };
    // A claim about renderers on the CPU is no less true without a GPU
    let grounds_of = if claim.about == About::Gpu { gpu } else { None };
    let Grounds { basis, without_gpu, mut warnings } = Grounds::of(claim.basis, grounds_of, None, claim.remark);
    if let Some(gpu) = gpu.filter(|gpu| claim.about == About::Both && gpu.is_software()) {
        warnings.push(format!("Its GPU is {}, which computes on the CPU.", gpu.label));
    }
    let cases = (claim.cases)(asked);
    let printed = (claim.cases)(printed);
    Finding {
        device: device.map_or(String::new(), |device| device.label.clone()),
        without_gpu,
        failed: failed(claim, asked),
        left_out: (claim.left_out)(asked),
        warnings,
        ..Finding::of(claim.statement(), basis, cases, &printed)
    }
}

/// The rows of a claim's renderers in the paper's structure that never gave a result.
fn failed(claim: &Claim, asked: &Asked) -> Vec<String> {
    let View { data, place, terms } = asked.view;
    let of_claim = |f: &&super::data::Failure| {
        let is_stage = Stage::ALL
            .iter()
            .any(|stage| f.setting.is_like(&super::setting::Setting::in_version(f.setting.renderer, stage.version())));
        place.has(f.machine, f.device)
            && f.terms == terms
            && f.scene.is_of_paper()
            && claim.renderers.contains(&f.setting.renderer)
            && is_stage
            && asked.view.like(&f.scene, &f.setting).is_none()
    };
    data.failures.iter().filter(of_claim).map(|f| format!("{} {} ({})", f.scene, f.setting, f.message)).collect()
}

impl Claim {
    fn statement(&self) -> Statement {
        Statement {
            source: SOURCE.name,
            document: DOCUMENT,
            claim: self.id,
            statement: self.statement,
            needs: self.needs,
        }
    }
}

impl<'a> Asked<'a> {
    /// The paper's scenes that have rows.
    fn scenes(&self) -> Vec<SceneKey> {
        Role::PAPER.into_iter().filter_map(|role| self.view.scene(role)).collect()
    }

    fn row(&self, scene: &SceneKey, renderer: Renderer, version: Version) -> Option<&'a Measurement> {
        self.view.version(scene, renderer, version)
    }

    fn time(&self, scene: &SceneKey, renderer: Renderer, version: Version) -> Option<Uncertain> {
        self.row(scene, renderer, version).map(Measurement::time)
    }

    fn stage(&self, scene: &SceneKey, renderer: Renderer, stage: Stage) -> Option<Uncertain> {
        self.time(scene, renderer, stage.version())
    }

    /// Processors of a row, as they are counted for the Karp-Flatt metric.
    fn processors(&self, m: &Measurement) -> Option<f64> {
        let renderer = m.setting.renderer;
        match (self.printed, renderer) {
            (Some(printed), _) => printed.processors(renderer).map(|p| f64::from(p.processors)),
            (None, Renderer::Gpu) => self.gpu_processors.map(f64::from),
            (None, _) => self.view.processors(m).map(|(number, _)| number as f64),
        }
    }

    /// What the Karp-Flatt metric of a row needs; `None` with a single processor.
    fn parallel(&self, scene: &SceneKey, renderer: Renderer, stage: Stage) -> Option<Parallel> {
        let row = self.row(scene, renderer, stage.version())?;
        let sequential = self.stage(scene, Renderer::Sequential, stage)?;
        let processors = self.processors(row).filter(|p| *p > 1.0)?;
        Some(Parallel { share: quotient(row.time(), sequential), processors })
    }
}

/// A case of a scene.
fn case(scene: &SceneKey, what: impl Into<String>, outcome: crate::compare::judge::Outcome, numbers: String) -> Case {
    Case { scene: scene.role.name().into(), what: what.into(), outcome, numbers }
}
