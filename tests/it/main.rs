//! All integration tests, in one crate so that they link once.

mod accel; // builders x degenerate inputs, validation, memory model, determinism
mod architecture; // who may use whom, and which files may use wgpu, clocks and output
mod camera; // camera paths: files, thinning, fitting, errors
mod changes; // compare, gate, bless and ab as a user runs them
mod cli; // the program as a user runs it: outputs, exit codes, broken input
mod compare; // pairs, judgements and statistics against known answers
mod device; // frames of several passes, indirect dispatch, textures, features
mod documents; // examples of YAML, TOML and JSON in documents parse
mod environment; // what spoils times is found in fake system files
mod exact; // the ray/triangle test against exact arithmetic
mod fakes; // records with known content, a device that breaks on demand
mod files; // names of files of all kinds, and what must not be written over
mod identities; // hashes of kernels and readers do not depend on comments
mod incoherent; // ambient and diffuse rays: their distribution, formulas, rows
mod journals; // journals of any number of rows
mod kernel_costs; // the static cost of kernels by hand, and that none is left out
mod kernels; // every kernel variant through naga, struct layouts, no GPU
mod language; // comments and documents are at most 120 columns wide
mod loops; // forms of the loops of bvh-stack, and ways without a stack
mod many; // shards, merged runs, runs that are killed and resumed
mod meshes; // closed meshes, and rays at their vertices and edges
mod packets; // planted faults in packets of a subgroup, triangles in leaf order
mod query; // the driver's own structure against a twin, and its rows
mod reference; // rays traced by Embree (needs RTBENCH_SCENES)
mod report; // tables of any source in every format, parts of documents
mod results; // journal, CSV and JSON agree; statistics; rays and hits
mod ropes; // the kd-tree's ropes against its full stack, ray by ray
mod scene; // readers and what breaks them, memory while loading, caches, procedural scenes, the catalogue
mod schema; // JSON Schema of journals and run.json against the types and real files
mod simt; // warps: hand-made events, every twin, the thesis of 2009 ordered by issued work
mod sources; // published numbers; tables, claims, figures and report from records
mod spheres; // the sphere tracer: the same bits from every renderer, broken lanes, closed forms, work
mod splat; // photon splatting: scans, twins and kernels, proof against closed forms and paths from the eye, rows
mod staged; // frames of several passes against those of one
mod support; // small scenes, random numbers, the GPU if there is one
mod sweep; // the sweep loop on a device that breaks, presets, the plan
mod toy; // a workload of a few lines on the harness
mod traversal; // every traversal against brute force, CPU twins and GPU
mod verify; // the verifier notices one wrong pixel
mod watertight; // no ray is lost at edges, on lattices, from afar
mod wide; // what wide trees cost rays, counted over frames
