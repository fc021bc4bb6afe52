//! Frames of a ray configuration on a device: the kernels of their passes, the uniforms, and the lists between passes.

use super::kernels::{Entry, StagedPass, TAKEN, packet_passes};
use super::prepared::GpuPrepared;
use super::shared::{FrameUniform, LENGTH, WaitingPath};
use crate::camera::View;
use crate::device::vulkan::{Bindings, Buffer, Dispatch, Groups, MAX_TIMESTAMPS, Pipeline, ReadBuffer, Resource};
use crate::device::{Frame, Pass, Stage, Submissions};
use crate::error::{Error, Result};
use crate::scene::Light;
use crate::workloads::trace::Method;
use crate::workloads::trace::backend::*;
use crate::workloads::trace::method::{Group, Reflections, Threads};
use std::sync::Arc;

/// The one stage of a fused frame: rays are generated, traced and shaded by one kernel.
const RENDER: [Stage; 1] = [Stage("render")];

/// The stages of a staged frame: a pass for the primary rays, and one for each reflection.
const STAGED: [Stage; 1 + MAX_BOUNCES as usize] = [Stage("primary"), Stage("reflection-1"), Stage("reflection-2")];

/// The stages of a frame of packets.
const PACKETS: [Stage; 2] = [Stage("hits"), Stage("shade")];

/// A part of an image, and the index of the output pixel where it would begin if it had all columns.
pub(super) type Part = (Tile, u32);

/// Uniforms and lights of many frames, uploaded before any of them runs.
struct FrameInputs {
    uniforms: Buffer,
    lights: ReadBuffer,
    /// Bytes between the uniforms of two parts.
    stride: u32,
    /// Columns and rows of each part.
    extents: Vec<(u32, u32)>,
    parts_per_frame: usize,
}

/// The list that a pass of a staged frame makes for the next one.
struct List {
    /// For each part the work-groups of an indirect dispatch, and the number of paths.
    lengths: Buffer,
    /// Of the part that is worked on.
    paths: Buffer,
}

/// Frames that are ready to run.
pub(super) struct Rendering<'p> {
    pipelines: &'p [Arc<Pipeline>],
    bindings: Vec<Bindings>,
    lists: Vec<List>,
    inputs: FrameInputs,
    stages: &'static [Stage],
    /// Pixels of a work-group of each pass.
    shapes: Vec<Group>,
    /// Most work-groups of a dispatch, where each takes pixels until none are left.
    persistent: Option<u32>,
}

/// Work-groups of persistent threads on a GPU: more than any has resident at a time. Those that begin late find no
/// pixels left.
const PERSISTENT_GROUPS: u32 = 4096;

/// The stages of a frame.
pub(super) fn stages(method: Method, config: Config) -> &'static [Stage] {
    if method.traversal.packets.is_some() {
        &PACKETS
    } else if method.is_staged(config.bounces()) {
        &STAGED[..=config.bounces() as usize]
    } else {
        &RENDER
    }
}

/// The kernels of a frame's passes, in their order.
pub(super) fn entries_of(method: Method, config: Config, counting: bool) -> Vec<Entry> {
    if method.traversal.packets.is_some() {
        packet_passes(config, counting).into()
    } else if method.is_staged(config.bounces()) {
        StagedPass::all(config).into_iter().map(|pass| Entry::Staged { config, counting, pass }).collect()
    } else {
        vec![Entry::Render { config, counting }]
    }
}

impl GpuPrepared<'_> {
    /// The compiled kernels of a frame's passes.
    pub(super) fn pipelines(&self, config: Config, counting: bool) -> Result<Vec<Arc<Pipeline>>> {
        entries_of(self.method, config, counting).into_iter().map(|entry| self.compiled(entry)).collect()
    }

    /// Uploads what frames of these views need, each in these parts.
    pub(super) fn rendering<'p>(
        &self,
        pipelines: &'p [Arc<Pipeline>],
        (views, size): (&[View], Size),
        parts: &[Part],
        output: &Buffer,
    ) -> Result<Rendering<'p>> {
        let Method { traversal, parameters, group, .. } = self.method;
        let (stages, shapes, listed) = match traversal.packets {
            Some(packets) => (&PACKETS[..], vec![packets(&parameters), group], 0),
            None => (&STAGED[..], vec![group; pipelines.len()], pipelines.len() - 1),
        };
        let inputs = self.frame_inputs(views, size, parts)?;
        self.check_groups(&inputs, &shapes)?;
        let is_persistent = self.method.threads == Threads::Persistent;
        // One count for each part, which is dispatched once
        let taken = is_persistent
            .then(|| self.device.zeroed("the groups that are taken", 4 * inputs.extents.len() as u64))
            .transpose()?;
        let persistent = is_persistent.then(|| match self.device.info().software_threads() {
            0 => PERSISTENT_GROUPS,
            threads => threads,
        });
        let lists = (0..listed).map(|_| self.list(inputs.extents.len(), parts)).collect::<Result<Vec<_>>>()?;
        let bindings = pipelines.iter().enumerate().map(|(pass, pipeline)| {
            let mut others: Vec<(u32, Resource)> = vec![(5, (&inputs.lights).into()), (8, output.into())];
            others.extend(taken.as_ref().map(|taken| (TAKEN, taken.into())));
            if let Some(List { lengths, paths }) = lists.get(pass) {
                others.extend([(9, lengths.into()), (10, paths.into())]);
            }
            if let Some(List { lengths, paths }) = pass.checked_sub(1).and_then(|before| lists.get(before)) {
                others.extend([(11, lengths.into()), (12, paths.into())]);
            }
            self.render_bindings(pipeline, &inputs.uniforms, &others)
        });
        Ok(Rendering { pipelines, bindings: bindings.collect(), lists, inputs, stages, shapes, persistent })
    }

    /// A list for parts of an image, of which `uploaded` are uploaded for all views.
    fn list(&self, uploaded: usize, parts: &[Part]) -> Result<List> {
        let pixels = |tile: &Tile| u64::from(tile.columns) * u64::from(tile.rows);
        let largest = parts.iter().map(|(tile, _)| pixels(tile)).max().unwrap_or(0);
        Ok(List {
            lengths: self.device.indirect("the lengths of lists", &vec![LENGTH; uploaded])?,
            paths: self.device.zeroed("the list of reflecting pixels", largest * size_of::<WaitingPath>() as u64)?,
        })
    }

    /// Uploads the uniforms of all parts of all views.
    fn frame_inputs(&self, views: &[View], size: Size, parts: &[Part]) -> Result<FrameInputs> {
        let stride = self.device.uniform_stride(size_of::<FrameUniform>());
        let mut uniforms = Vec::with_capacity(views.len() * parts.len() * stride as usize);
        let mut lights: Vec<Light> = Vec::new();
        let mut extents = Vec::with_capacity(views.len() * parts.len());
        for view in views {
            let grid = view.camera.pixel_grid(size.width, size.height);
            for &(tile, first_pixel) in parts {
                let uniform = FrameUniform {
                    origin: grid.origin,
                    width: size.width,
                    corner: grid.corner,
                    first_row: tile.row,
                    right: grid.right,
                    rows: tile.rows,
                    down: grid.down,
                    epsilon: self.lengths.epsilon,
                    background: self.scene.background,
                    light_count: view.lights.len() as u32,
                    first_light: lights.len() as u32,
                    first_pixel,
                    first_column: tile.column,
                    columns: tile.columns,
                    height: size.height,
                    shadow_reach: self.lengths.reach,
                    part: extents.len() as u32,
                    ambient_reach: self.lengths.ambient,
                };
                uniforms.extend_from_slice(bytemuck::bytes_of(&uniform));
                uniforms.resize(uniforms.len().next_multiple_of(stride as usize), 0);
                extents.push((tile.columns, tile.rows));
            }
            lights.extend_from_slice(&view.lights);
        }
        Ok(FrameInputs {
            uniforms: self.device.uniform("the frames", &uniforms)?,
            lights: self.uploaded.input(self.device, "the lights", bytemuck::cast_slice(&lights))?,
            stride,
            extents,
            parts_per_frame: parts.len(),
        })
    }

    /// Refuses images with more work-groups than a dispatch has.
    fn check_groups(&self, inputs: &FrameInputs, shapes: &[Group]) -> Result<()> {
        let most = self.device.max_groups();
        let groups = shapes.iter().flat_map(|shape| inputs.extents.iter().map(|extent| groups_of(*extent, *shape)));
        match groups.into_iter().find(|(x, y)| *x.max(y) > most) {
            Some((x, y)) => {
                let problem = format!("{x} x {y} work-groups are more than this device's {most} per dimension");
                Err(Error::too_large("the image", problem, "use a smaller one"))
            }
            None => Ok(()),
        }
    }

    fn render_bindings(&self, pipeline: &Pipeline, uniforms: &Buffer, others: &[(u32, Resource)]) -> Bindings {
        let uniform = Resource::Window(uniforms, size_of::<FrameUniform>() as u64);
        let of_scene = [(3, (&self.uploaded.materials).into()), (4, (&self.uploaded.triangle_materials).into())];
        self.bind(pipeline, uniform, &[&of_scene, others].concat())
    }

    /// Splits an image into about `across` x `down` parts of whole work-groups, each with its own place in the output;
    /// into more where the list of a staged frame would not fit.
    pub(super) fn parts(&self, size: Size, across: u32, down: u32) -> Vec<Part> {
        let down = down.max(size.height.div_ceil(self.rows_of_a_list(size)));
        tiles(size, across, down, self.method.group).into_iter().map(|tile| (tile, tile.row * size.width)).collect()
    }

    /// The rows of a part whose list can be bound as one buffer and dispatched in one dimension.
    fn rows_of_a_list(&self, size: Size) -> u32 {
        if self.method.reflections == Reflections::Fused {
            return size.height;
        }
        let group = self.method.group;
        let bound = self.device.max_binding() / size_of::<WaitingPath>() as u64;
        let paths = bound.min(u64::from(self.device.max_groups()) * u64::from(group.size()));
        let rows = u32::try_from(paths / u64::from(size.width)).unwrap_or(u32::MAX);
        if rows >= size.height {
            return size.height;
        }
        // A part has whole work-groups
        (rows / group.height * group.height).max(group.height)
    }
}

/// Work-groups of this shape that cover so many columns and rows, in columns and rows.
fn groups_of((columns, rows): (u32, u32), shape: Group) -> (u32, u32) {
    (columns.div_ceil(shape.width), rows.div_ceil(shape.height))
}

impl Rendering<'_> {
    /// The frames that were uploaded, each with the passes of all its parts.
    pub fn frames(&self) -> Vec<Frame<Dispatch<'_>>> {
        let parts: Vec<Frame<Dispatch>> = self.parts().collect();
        let frames = parts.chunks(self.inputs.parts_per_frame).map(|parts| Frame {
            passes: parts.iter().flat_map(|part| part.passes.clone()).collect(),
            submissions: parts[0].submissions,
        });
        frames.collect()
    }

    /// The parts of all frames, each as a frame.
    pub fn parts(&self) -> impl Iterator<Item = Frame<Dispatch<'_>>> {
        // Many parts change the stage more often than a frame has timestamps: then the frame is timed as a whole
        let passes = self.inputs.parts_per_frame * self.pipelines.len();
        let by_stage = self.pipelines.len() > 1 && 2 * passes <= MAX_TIMESTAMPS;
        // A watchdog asks for parts, which it is to see alone; without parts the host is not to be seen between passes
        let is_whole = self.inputs.parts_per_frame == 1 && self.pipelines.len() > 1;
        let submissions = if is_whole { Submissions::PerFrame } else { Submissions::PerPass };
        (0u32..).zip(&self.inputs.extents).map(move |(part, &extent)| {
            let passes = self.pipelines.iter().enumerate().map(|(pass, pipeline)| {
                let groups = match pass.checked_sub(1).and_then(|before| self.lists.get(before)) {
                    None => {
                        let (x, y) = groups_of(extent, self.shapes[pass]);
                        match self.persistent {
                            Some(most) => Groups::Fixed((x * y).min(most), 1, 1),
                            None => Groups::Fixed(x, y, 1),
                        }
                    }
                    Some(list) => Groups::Indirect {
                        buffer: &list.lengths,
                        offset: u64::from(part) * size_of_val(&LENGTH) as u64,
                    },
                };
                let offset = Some(part * self.inputs.stride);
                Pass {
                    stage: if by_stage { self.stages[pass] } else { RENDER[0] },
                    work: Dispatch { pipeline, bindings: &self.bindings[pass], offset, groups },
                }
            });
            Frame { passes: passes.collect(), submissions }
        })
    }
}
