//! First touches: where the part stops the tool, one by one and in columns.

/// The position at which the part stops the tool.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Touch {
    /// Z of the nose centre, mm; Z of the contact if the path is that of the contact.
    pub z: f64,
    /// Radius of the contact, mm; negative beyond the axis.
    pub foot: f64,
    /// Slope of the profile at the contact.
    pub slope: f64,
}

impl Touch {
    pub(crate) const NOWHERE: Self = Self {
        z: f64::NAN,
        foot: f64::NAN,
        slope: f64::NAN,
    };
}

/// First touches, with a column for each quantity of [`Touch`]; NaN where there is none.
#[derive(Default)]
pub(crate) struct Touches {
    pub z: Vec<f64>,
    pub foot: Vec<f64>,
    pub slope: Vec<f64>,
}

impl Touches {
    /// Makes room for so many touches. What they are is open.
    pub fn resize(&mut self, count: usize) {
        for column in [&mut self.z, &mut self.foot, &mut self.slope] {
            column.resize(count, f64::NAN);
        }
    }

    /// Sets the first `count` touches to those of others.
    pub fn begin_with(&mut self, others: &Self, count: usize) {
        let pairs = [
            (&mut self.z, &others.z),
            (&mut self.foot, &others.foot),
            (&mut self.slope, &others.slope),
        ];
        for (own, others) in pairs {
            own[..count].copy_from_slice(&others[..count]);
        }
    }

    /// Forgets all touches from number `first` on.
    pub fn clear_from(&mut self, first: usize) {
        for column in [&mut self.z, &mut self.foot, &mut self.slope] {
            column[first..].fill(f64::NAN);
        }
    }

    /// The touch at `index`.
    pub fn at(&self, index: usize) -> Touch {
        Touch {
            z: self.z[index],
            foot: self.foot[index],
            slope: self.slope[index],
        }
    }

    /// Sets the touch at `index`.
    pub fn set(&mut self, index: usize, touch: Touch) {
        self.z[index] = touch.z;
        self.foot[index] = touch.foot;
        self.slope[index] = touch.slope;
    }

    /// All touches in order.
    pub fn iter(&self) -> impl Iterator<Item = Touch> + '_ {
        (0..self.z.len()).map(|index| self.at(index))
    }
}
