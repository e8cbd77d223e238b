//! The tool path: control points in blocks, and the cubics that the controller plays between them.

use serde::{Deserialize, Serialize};

/// The section of the path to which a point belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Section {
    /// The way from rest to the part.
    LeadIn = 0,
    /// The cut on the part.
    Cutting = 1,
    /// The way from the part to rest.
    LeadOut = 2,
}

/// What the controller plays between neighbouring control points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SegmentShape {
    /// The cubic Hermite segment of both points' positions and velocities: a PVT move.
    #[default]
    Cubic,
    /// A straight line at constant speed on each axis. The line does not use the velocities of the
    /// points. The velocity of a point is the rate of the segment that follows it.
    Linear,
}

/// Largest velocity of an axis, mm/s or rad/s: far beyond that of any machine. With a far larger one the end of a
/// played cubic is rounding alone.
pub const LARGEST_VELOCITY: f64 = 1e12;

/// One control point.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ControlPoint {
    /// Time, s.
    pub t: f64,
    /// C angle, unwrapped, rad.
    pub c: f64,
    /// X of the nose centre, mm.
    pub x: f64,
    /// Z of the nose centre, mm.
    pub z: f64,
    /// dC/dt, rad/s.
    pub vc: f64,
    /// dX/dt, mm/s.
    pub vx: f64,
    /// dZ/dt, mm/s.
    pub vz: f64,
}

impl ControlPoint {
    /// The first velocity that is larger than [`LARGEST_VELOCITY`] or no number, in words.
    pub fn wild_velocity(&self) -> Option<String> {
        let named = [
            ("vC", self.vc, "rad/s"),
            ("vX", self.vx, "mm/s"),
            ("vZ", self.vz, "mm/s"),
        ];
        named.into_iter().find_map(|(name, velocity, unit)| {
            if !velocity.is_finite() {
                return Some(format!("{name} = {velocity} is not finite"));
            }
            let is_wild = velocity.abs() > LARGEST_VELOCITY;
            is_wild.then(|| format!("{name} = {velocity:e} {unit} is faster than any machine"))
        })
    }

    /// Whether every number is finite.
    pub fn is_finite(&self) -> bool {
        [self.t, self.c, self.x, self.z, self.vc, self.vx, self.vz]
            .iter()
            .all(|v| v.is_finite())
    }
}

/// Neighbouring control points of one section, with a column for each quantity.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PathBlock {
    /// Time, s.
    pub t: Vec<f64>,
    /// C angle, unwrapped, rad.
    pub c: Vec<f64>,
    /// X of the nose centre, mm.
    pub x: Vec<f64>,
    /// Z of the nose centre, mm.
    pub z: Vec<f64>,
    /// dC/dt, rad/s.
    pub vc: Vec<f64>,
    /// dX/dt, mm/s.
    pub vx: Vec<f64>,
    /// dZ/dt, mm/s.
    pub vz: Vec<f64>,
    /// What the controller plays between the points.
    pub shape: SegmentShape,
}

impl PathBlock {
    /// A block without points that has room for so many.
    pub fn with_capacity(points: usize) -> Self {
        let room = || Vec::with_capacity(points);
        Self {
            t: room(),
            c: room(),
            x: room(),
            z: room(),
            vc: room(),
            vx: room(),
            vz: room(),
            shape: SegmentShape::default(),
        }
    }

    /// A block of these points, between which a controller plays this.
    pub fn of(shape: SegmentShape, points: impl IntoIterator<Item = ControlPoint>) -> Self {
        let points = points.into_iter();
        let mut block = Self {
            shape,
            ..Self::with_capacity(points.size_hint().0)
        };
        points.for_each(|point| block.push(point));
        block
    }

    /// The number of control points.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// Whether the block has no control points.
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// Appends a control point.
    pub fn push(&mut self, point: ControlPoint) {
        self.t.push(point.t);
        self.c.push(point.c);
        self.x.push(point.x);
        self.z.push(point.z);
        self.vc.push(point.vc);
        self.vx.push(point.vx);
        self.vz.push(point.vz);
    }

    /// Replaces the last point by `point`.
    pub fn set_last(&mut self, point: ControlPoint) {
        self.truncate(self.len().saturating_sub(1));
        self.push(point);
    }

    /// Keeps the first `count` points.
    pub fn truncate(&mut self, count: usize) {
        let Self {
            t,
            c,
            x,
            z,
            vc,
            vx,
            vz,
            shape: _,
        } = self;
        for column in [t, c, x, z, vc, vx, vz] {
            column.truncate(count);
        }
    }

    /// The control point at `index`, if there is one.
    #[inline]
    pub fn get(&self, index: usize) -> Option<ControlPoint> {
        Some(ControlPoint {
            t: *self.t.get(index)?,
            c: *self.c.get(index)?,
            x: *self.x.get(index)?,
            z: *self.z.get(index)?,
            vc: *self.vc.get(index)?,
            vx: *self.vx.get(index)?,
            vz: *self.vz.get(index)?,
        })
    }

    /// All control points in order.
    pub fn points(&self) -> impl Iterator<Item = ControlPoint> + '_ {
        let times = self.t.iter().zip(&self.c).zip(&self.x).zip(&self.z);
        let rates = self.vc.iter().zip(&self.vx).zip(&self.vz);
        times
            .zip(rates)
            .map(|((((t, c), x), z), ((vc, vx), vz))| ControlPoint {
                t: *t,
                c: *c,
                x: *x,
                z: *z,
                vc: *vc,
                vx: *vx,
                vz: *vz,
            })
    }

    /// The segment from the point at `index` to the next one, in the block's shape.
    #[inline]
    pub fn segment(&self, index: usize) -> Option<Segment> {
        let (from, to) = (self.get(index)?, self.get(index + 1)?);
        Some(Segment::of_shape(self.shape, &from, &to))
    }

    /// The segments between neighbouring points, in the block's shape.
    pub fn segments(&self) -> impl Iterator<Item = Segment> + '_ {
        let (from, to) = (self.points(), self.points().skip(1));
        from.zip(to)
            .map(|(from, to)| Segment::of_shape(self.shape, &from, &to))
    }
}

/// A block of neighbouring control points of one section on its way to the files, with the points
/// before it. That is enough to write times and distances that do not depend on where a block
/// begins.
#[derive(Debug, Clone, Copy)]
pub struct SectionBlock<'a> {
    /// The section of the points.
    pub section: Section,
    /// Whether the section begins with the block's first point.
    pub opens_section: bool,
    /// The two points before the block's first one, as far as the path has them.
    pub before: &'a [ControlPoint],
    /// The points. Each point of a path is in exactly one block.
    pub points: &'a PathBlock,
}

/// A cubic Σ a_i s^i on s = 0 … 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cubic(pub [f64; 4]);

impl Cubic {
    /// The cubic Hermite polynomial from (p0, v0) to (p1, v1) within `duration`.
    #[inline(always)]
    pub fn hermite(p0: f64, v0: f64, p1: f64, v1: f64, duration: f64) -> Self {
        let (rise, m0, m1) = (p1 - p0, v0 * duration, v1 * duration);
        Self([p0, m0, 3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise])
    }

    /// The straight line from p0 to p1.
    #[inline(always)]
    pub fn straight(p0: f64, p1: f64) -> Self {
        Self([p0, p1 - p0, 0.0, 0.0])
    }

    /// The value at `s`.
    #[inline(always)]
    pub fn value(&self, s: f64) -> f64 {
        let [a, b, c, d] = self.0;
        a + s * (b + s * (c + s * d))
    }

    /// The derivative in s.
    #[inline(always)]
    pub fn slope(&self, s: f64) -> f64 {
        let [_, b, c, d] = self.0;
        b + s * (2.0 * c + s * 3.0 * d)
    }

    /// The second derivative in s.
    #[inline(always)]
    pub fn bend(&self, s: f64) -> f64 {
        let [_, _, c, d] = self.0;
        2.0 * c + 6.0 * s * d
    }

    /// The third derivative in s.
    #[inline(always)]
    pub fn jerk(&self) -> f64 {
        6.0 * self.0[3]
    }
}

/// What the controller plays between two control points: one cubic for each axis on s = 0 … 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Time at which the segment begins, s.
    pub start: f64,
    /// Duration of the segment, s.
    pub duration: f64,
    /// C, rad.
    pub c: Cubic,
    /// X, mm.
    pub x: Cubic,
    /// Z, mm.
    pub z: Cubic,
}

impl Segment {
    /// The move of this shape from one control point to the next.
    #[inline(always)]
    pub fn of_shape(shape: SegmentShape, from: &ControlPoint, to: &ControlPoint) -> Self {
        match shape {
            SegmentShape::Cubic => Self::between(from, to),
            SegmentShape::Linear => Self::straight(from, to),
        }
    }

    /// The PVT move from one control point to the next.
    #[inline(always)]
    pub fn between(from: &ControlPoint, to: &ControlPoint) -> Self {
        let duration = to.t - from.t;
        Self {
            start: from.t,
            duration,
            c: Cubic::hermite(from.c, from.vc, to.c, to.vc, duration),
            x: Cubic::hermite(from.x, from.vx, to.x, to.vx, duration),
            z: Cubic::hermite(from.z, from.vz, to.z, to.vz, duration),
        }
    }

    /// The straight move from one control point to the next. It does not use their velocities.
    #[inline(always)]
    pub fn straight(from: &ControlPoint, to: &ControlPoint) -> Self {
        Self {
            start: from.t,
            duration: to.t - from.t,
            c: Cubic::straight(from.c, to.c),
            x: Cubic::straight(from.x, to.x),
            z: Cubic::straight(from.z, to.z),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hermite_gives_back_the_cubic_it_was_made_from() {
        let p = |t: f64| 2.0 + t * (-1.0 + t * (0.5 + t * 3.0));
        let v = |t: f64| -1.0 + t * (1.0 + t * 9.0);
        let cubic = Cubic::hermite(p(0.25), v(0.25), p(0.75), v(0.75), 0.5);
        for i in 0..=10 {
            let s = f64::from(i) / 10.0;
            let t = 0.25 + 0.5 * s;
            assert!((cubic.value(s) - p(t)).abs() < 1e-14);
            assert!((cubic.slope(s) - 0.5 * v(t)).abs() < 1e-14);
        }
        assert!((cubic.jerk() - 18.0 * 0.125).abs() < 1e-13);
    }

    #[test]
    fn a_blocks_shape_is_that_of_its_segments() {
        let point = |t: f64, z: f64, vz: f64| ControlPoint {
            t,
            z,
            vz,
            ..ControlPoint::default()
        };
        let mut block = PathBlock::default();
        block.push(point(0.0, 1.0, 7.0));
        block.push(point(2.0, 3.0, -7.0));
        let middle = |block: &PathBlock| block.segments().next().map(|s| s.z.value(0.5));
        assert_eq!(middle(&block), Some(5.5));
        block.shape = SegmentShape::Linear;
        assert_eq!(middle(&block), Some(2.0));
        let straight = block
            .segments()
            .next()
            .map(|s| (s.z.slope(0.3), s.z.jerk()));
        assert_eq!(straight, Some((2.0, 0.0)));
    }
}
