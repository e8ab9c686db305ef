//! Where an actor goes.

/// A smooth path in the world: a straight line, an arc or a circle, by one formula.
pub(super) struct Path {
    /// Where it is when `way` is 0.
    pub(super) anchor: [f64; 2],
    /// Pixels per unit of the way.
    pub(super) velocity: [f64; 2],
    /// Factors of the sine and of one minus the cosine of the angle, pixels.
    pub(super) bow: [[f64; 2]; 2],
    /// Angle per unit of the way, radians.
    pub(super) rate: f64,
    /// The way at every moment: frames at full speed.
    pub(super) way: Vec<f64>,
}

impl Path {
    pub(super) fn at(&self, moment: f64) -> [f64; 2] {
        let before = moment as usize;
        let after = (before + 1).min(self.way.len() - 1);
        let way = self.way[before] + (moment - before as f64) * (self.way[after] - self.way[before]);
        let (sine, rise) = (libm::sin(self.rate * way), 1.0 - libm::cos(self.rate * way));
        [0, 1].map(|k| self.anchor[k] + self.velocity[k] * way + self.bow[0][k] * sine + self.bow[1][k] * rise)
    }

    /// Whether it stands still from a moment to the next.
    pub(super) fn rests(&self, moment: usize) -> bool {
        self.way.get(moment + 1) == Some(&self.way[moment])
    }
}

/// The way of one who stands still in the moments `stop`, slowing down and speeding up over four frames; 0 while it stands.
pub(super) fn with_stop(moments: usize, stop: std::ops::Range<usize>) -> Vec<f64> {
    const RAMP: f64 = 4.0;
    let speed = |moment: usize| {
        let distance = if moment < stop.start { stop.start - moment } else { (moment + 1).saturating_sub(stop.end) };
        (distance as f64 / RAMP).min(1.0)
    };
    let mut way = Vec::with_capacity(moments);
    let mut sum = 0.0;
    for moment in 0..moments {
        way.push(sum);
        sum += speed(moment);
    }
    let rest = way[stop.start.min(moments - 1)];
    way.iter_mut().for_each(|w| *w -= rest);
    way
}
