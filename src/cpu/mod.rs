//! stub
use crate::{Result, accel::*, backend::*, camera::View, math::*, scene::Scene};
use std::time::Instant;
/// stub
pub struct CpuBackend(DeviceInfo);
impl CpuBackend {
    /// stub
    pub fn new(threads: usize) -> CpuBackend {
        CpuBackend(DeviceInfo {
            name: "stub CPU".into(),
            device_type: DeviceType::CpuTwin,
            backend: "cpu".into(),
            driver: String::new(),
            timestamp_period_ns: None,
            checked: false,
            features: vec![],
            limits: Default::default(),
            threads: Some(threads.max(1)),
        })
    }
}
impl Backend for CpuBackend {
    fn info(&self) -> &DeviceInfo {
        &self.0
    }
    fn prepare<'a>(
        &'a self,
        scene: &'a Scene,
        structure: &'a Structure,
        _: Traversal,
    ) -> Result<Box<dyn Prepared + 'a>> {
        Ok(Box::new(P(scene, structure)))
    }
}
struct P<'a>(&'a Scene, &'a Structure);
impl P<'_> {
    fn hit(&self, o: glam::Vec3A, d: glam::Vec3A) -> Hit {
        let ray = Ray::new(o, d);
        let mut h = Hit::NONE;
        for i in 0..self.0.triangles.len() as u32 {
            let [a, b, c] = self.0.corners(i);
            if let Some(t) = intersect(&ray, a, b, c, h.t) {
                if t.t < h.t {
                    h = Hit { t: t.t, triangle: i };
                }
            }
        }
        h
    }
}
impl Prepared for P<'_> {
    fn image(&mut self, c: Config, v: &View, s: Size) -> Result<Vec<Pixel>> {
        let mut out = vec![];
        self.counted(c, v, s, &mut |_, p| out.extend(p.iter().map(|p| p.pixel)))?;
        Ok(out)
    }
    fn counted(&mut self, c: Config, v: &View, s: Size, band: &mut dyn FnMut(u32, &[CountedPixel])) -> Result<()> {
        let g = v.camera.pixel_grid(s.width, s.height);
        for y in 0..s.height {
            let row: Vec<CountedPixel> = (0..s.width)
                .map(|x| {
                    let d = (g.corner + g.right * (x as f32 + 0.5) + g.down * (y as f32 + 0.5)).normalize();
                    let h = self.hit(g.origin.into(), d.into());
                    let p = Counters { rays: 1, tests: self.0.triangles.len() as u32, ..Default::default() };
                    let q = if c.shadows() && h.triangle != MISS { p } else { Counters::default() };
                    CountedPixel {
                        pixel: Pixel {
                            triangle: h.triangle,
                            rgba: 0xff00_0000 | (h.triangle.wrapping_mul(77) & 0xffffff),
                        },
                        t: h.t.to_bits(),
                        pad: 0,
                        counters: [p, q, Counters::default()],
                    }
                })
                .collect();
            band(y, &row);
        }
        Ok(())
    }
    fn time_path(&mut self, c: Config, views: &[View], s: Size, i: Interrupted) -> Result<Vec<FrameTime>> {
        views
            .iter()
            .map(|v| {
                if i() {
                    return Err(crate::Error::Interrupted);
                }
                let t = Instant::now();
                self.image(c, v, s)?;
                Ok(FrameTime { device_ns: None, wall_ns: t.elapsed().as_nanos() as u64 })
            })
            .collect()
    }
    fn trace(&mut self, rays: &[GivenRay], any: bool) -> Result<Vec<Hit>> {
        Ok(rays
            .iter()
            .map(|r| {
                let h = self.hit(r.origin.into(), r.direction.into());
                if any && h.triangle != MISS { Hit { t: 0.0, triangle: 0 } } else { h }
            })
            .collect())
    }
    fn allocated(&self) -> (u64, u64) {
        (32 * self.0.vertices.len() as u64, self.1.structure_bytes())
    }
}
