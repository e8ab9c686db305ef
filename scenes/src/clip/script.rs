//! Who is in a shot and where everyone goes, so that the events asked for happen.

use std::f64::consts::PI;

use super::super::shape::{Kind, Shape};
use super::super::warp::Warp;
use super::actor::{Actor, Part};
use super::camera::{Camera, swung};
use super::occurrence::Watch;
use super::path::{Path, with_stop};
use super::{ClipSceneOptions, Event, Occurrence};
use veronese::Random;

/// How often a script is drawn again if an event does not happen in it: another object may be in the way.
const ATTEMPTS: usize = 40;

/// The camera and the actors of a shot.
pub(super) struct Script {
    pub(super) camera: Camera,
    /// From back to front.
    pub(super) actors: Vec<Actor>,
    /// In moments of the shot.
    pub(super) occurrences: Vec<Occurrence>,
}

impl Script {
    /// A shot of so many moments with these events; its objects are numbered from `next` on.
    pub(super) fn draw(
        random: &mut Random,
        options: &ClipSceneOptions,
        events: &[Event],
        moments: usize,
        next: u8,
    ) -> Script {
        let (moving, acted): (Vec<Event>, Vec<Event>) = events.iter().partition(|event| event.objects() == 0);
        let mut attempt = || {
            let (mut script, roles) =
                Director::new(random, options, &moving, moments, next).direct(&acted, options.objects);
            let watch = Watch::of(&script, [options.width, options.height]);
            let found = roles.iter().filter_map(|(event, objects)| watch.occurrence(*event, objects)).collect();
            script.occurrences = found;
            script
        };
        let mut script = attempt();
        for _ in 1..ATTEMPTS {
            if script.occurrences.len() == acted.len() {
                break;
            }
            let other = attempt();
            if other.occurrences.len() > script.occurrences.len() {
                script = other;
            }
        }
        let whole = |event| Occurrence { event, objects: Vec::new(), frames: 0..moments };
        script.occurrences.extend(moving.into_iter().map(whole));
        script
    }

    /// The numbers of its objects.
    pub(super) fn numbers(&self) -> Vec<u8> {
        self.actors.iter().map(|actor| actor.number).filter(|&number| number > 0).collect()
    }

    /// The number of the actor to which each part belongs.
    pub(super) fn owners(&self) -> Vec<u8> {
        self.actors.iter().flat_map(|actor| vec![actor.number; actor.parts.len()]).collect()
    }

    /// From each part to the frame.
    pub(super) fn parts(&self, moment: f64) -> Vec<Warp> {
        let (camera, time) = (self.camera.at(moment), self.camera.time(moment));
        self.actors.iter().flat_map(|actor| actor.at(moment, time)).map(|warp| camera.after(&warp)).collect()
    }
}

/// Draws a script: each event has a lane of the frame of its own, so that events seldom disturb each other.
struct Director<'a> {
    random: &'a mut Random,
    camera: Camera,
    actors: Vec<Actor>,
    roles: Vec<(Event, Vec<u8>)>,
    next: u8,
    moments: usize,
    size: [f64; 2],
    /// 1 at 320 × 240, proportional to the sides.
    unit: f64,
    /// Usual radius of an object, pixels.
    radius: f64,
}

impl<'a> Director<'a> {
    fn new(
        random: &'a mut Random,
        options: &ClipSceneOptions,
        events: &[Event],
        moments: usize,
        next: u8,
    ) -> Director<'a> {
        let size = [options.width as f64, options.height as f64];
        let unit = (size[0] * size[1]).sqrt() / 277.0;
        let angle = random.uniform(0.0, 2.0 * PI);
        let speed = random.uniform(0.8, 3.0) * unit.min(1.0);
        let rate = random.uniform(0.003, 0.007) * if random.unit() < 0.5 { 1.0 } else { -1.0 };
        let has = |event| f64::from(u8::from(events.contains(&event)));
        let pan = [speed * libm::cos(angle), speed * libm::sin(angle)].map(|v| has(Event::Pan) * v);
        let camera = Camera { centre: size.map(|s| 0.5 * s), pan, zoom: has(Event::Zoom) * rate, moments };
        Director { random, camera, actors: Vec::new(), roles: Vec::new(), next, moments, size, unit, radius: 0.0 }
    }

    fn direct(mut self, acted: &[Event], objects: usize) -> (Script, Vec<(Event, Vec<u8>)>) {
        let needed: usize = acted.iter().map(|event| event.objects()).sum();
        let lanes = acted.len() + objects.saturating_sub(needed);
        let order = self.random.choose(lanes, lanes);
        self.radius = f64::min(0.115, 0.42 / lanes.max(1) as f64) * self.size[1];
        for (k, lane) in order.into_iter().enumerate() {
            let x = self.random.uniform(0.38, 0.62) * self.size[0];
            let y = (lane as f64 + self.random.uniform(0.4, 0.6)) / lanes as f64 * self.size[1];
            let first = self.next;
            match acted.get(k) {
                Some(&event) => {
                    self.act(event, [x, y]);
                    self.roles.push((event, (first..self.next).collect()));
                }
                None => {
                    let speed = self.random.uniform(1.0, 5.0) * self.unit.min(1.0);
                    self.rigid([x, y], speed, 1.0);
                }
            }
        }
        (Script { camera: self.camera, actors: self.actors, occurrences: Vec::new() }, self.roles)
    }

    /// Casts an event at a place of the frame.
    fn act(&mut self, event: Event, place: [f64; 2]) {
        let moments = self.moments as f64;
        let slower = self.unit.min(1.0);
        match event {
            Event::Crossing => {
                let shapes = [self.shape(1.0), self.shape(1.0)];
                self.meet(place, shapes);
            }
            Event::HiddenByObject => {
                let small = self.shape(0.6);
                let axis = self.direction(PI);
                let kind = [Kind::Ellipse, Kind::Rectangle][self.random.below(2)];
                let large = Shape::oriented(kind, 1.7 * small.reach(), axis, self.random.uniform(1.0, 1.25));
                self.meet(place, [small, large]);
            }
            Event::HiddenByBackground => {
                let shape = self.shape(0.8);
                let reach = shape.reach();
                let speed = self.random.uniform(1.0, 1.4) * 2.0 * reach / (0.42 * moments);
                let wide = 2.0 * reach + speed * self.random.uniform(2.0, 5.0);
                let tall = self.random.uniform(2.6, 3.6) * reach;
                let velocity = self.along(speed, 0.1);
                let anchor = self.world(place, self.moments / 2);
                self.enlist(vec![Part::body(shape)], self.line(anchor, velocity, self.moments / 2));
                // A rectangle's sides are those of a square of the area of the circle, stretched.
                let radius = (wide * tall / PI).sqrt();
                let pillar = Part::body(Shape::oriented(Kind::Rectangle, radius, [0.0, 1.0], tall / wide));
                let path = self.line(anchor, [0.0; 2], 0);
                self.actors.push(Actor { number: 0, parts: vec![pillar], path, spin: 0.0, growth: 0.0 });
            }
            Event::StopAndGo => {
                let length = 5 + self.random.below(self.moments / 5);
                let start = self.moments / 2 - length / 2;
                let speed = self.random.uniform(2.5, 5.0) * slower;
                self.rigid(place, speed, 1.0);
                if let Some(actor) = self.actors.last_mut() {
                    actor.path.way = with_stop(self.moments, start..start + length);
                    (actor.spin, actor.growth) = (0.0, 0.0);
                }
            }
            Event::Entering | Event::Leaving => {
                let shape = self.shape(1.0);
                let quarter = self.moments / 4;
                let speed = self.random.uniform(1.3, 1.8) * shape.reach() / quarter as f64;
                let seen = self.along(speed, 0.25);
                let inwards = (seen[0] > 0.0) == (event == Event::Entering);
                let border = [if inwards { 0.0 } else { self.size[0] }, place[1]];
                let moment = if event == Event::Entering { quarter } else { self.moments - 1 - quarter };
                // As seen from the frame, not the world.
                let velocity = [0, 1].map(|k| seen[k] - self.camera.pan[k]);
                let path = self.line(self.world(border, moment), velocity, moment);
                self.enlist(vec![Part::body(shape)], path);
            }
            Event::Articulated => {
                let speed = self.random.uniform(1.5, 4.0) * slower;
                let parts = self.limbs();
                let velocity = self.along(speed, 0.2);
                let anchor = self.world(place, self.moments / 2);
                self.enlist(parts, self.line(anchor, velocity, self.moments / 2));
            }
            Event::Slow => {
                let speed = self.random.uniform(0.3, 0.8);
                self.rigid(place, speed, 1.0);
                if let Some(actor) = self.actors.last_mut() {
                    actor.path.bow = [[0.0; 2]; 2];
                }
            }
            Event::Fast => {
                let speed = self.random.uniform(10.0, 15.0) * slower;
                let circle = self.random.uniform(0.2, 0.28) * self.size[1];
                let turn = self.direction(2.0 * PI);
                let top = self.camera.centre.map(|c| c + self.random.uniform(-0.05, 0.05) * self.size[1]);
                let anchor = [0, 1].map(|k| top[k] - circle * turn[k]);
                let bow = [[-turn[1] * circle, turn[0] * circle], turn.map(|t| t * circle)];
                let way = (0..self.moments).map(|moment| moment as f64).collect();
                let path = Path { anchor, velocity: [0.0; 2], bow, rate: speed / circle, way };
                let shape = self.shape(0.8);
                self.enlist(vec![Part::body(shape)], path);
            }
            Event::Pan | Event::Zoom | Event::Cut | Event::Exposure | Event::Flash | Event::Repeats => {}
        }
    }

    /// Two objects in opposite directions, which meet in the middle of the shot and part before it ends; the second is in front.
    fn meet(&mut self, place: [f64; 2], shapes: [Shape; 2]) {
        let reach: f64 = shapes.iter().map(Shape::reach).sum();
        let relative = self.random.uniform(1.0, 1.4) * reach / (0.4 * self.moments as f64);
        let along = self.along(relative, 0.25);
        let share = self.random.uniform(0.3, 0.7);
        let anchor = self.world(place, self.moments / 2);
        for (shape, share) in shapes.into_iter().zip([share, share - 1.0]) {
            let path = self.line(anchor, along.map(|v| v * share), self.moments / 2);
            self.enlist(vec![Part::body(shape)], path);
        }
    }

    /// An object of one part that is at a place of the frame in the middle of the shot.
    fn rigid(&mut self, place: [f64; 2], speed: f64, size: f64) {
        let shape = self.shape(size);
        let velocity = self.along(speed, 0.3);
        let anchor = self.world(place, self.moments / 2);
        let mut path = self.line(anchor, velocity, self.moments / 2);
        let bend = self.random.uniform(-8.0, 8.0) * self.unit / speed.max(1e-9);
        path.bow[1] = [-velocity[1] * bend, velocity[0] * bend];
        self.enlist(vec![Part::body(shape)], path);
    }

    fn enlist(&mut self, parts: Vec<Part>, path: Path) {
        // Who has limbs stays upright.
        let spin = if parts.len() == 1 { self.random.uniform(-0.012, 0.012) } else { 0.0 };
        let growth = self.random.uniform(-0.003, 0.003);
        self.actors.push(Actor { number: self.next, parts, path, spin, growth });
        self.next += 1;
    }

    /// A way through the world that is at `anchor` at a moment.
    fn line(&self, anchor: [f64; 2], velocity: [f64; 2], moment: usize) -> Path {
        let middle = self.camera.time(moment as f64);
        let way = |m: usize| swung(self.camera.time(m as f64) - middle, self.moments, 0.15);
        let way = (0..self.moments).map(way).collect();
        Path { anchor, velocity, bow: [[0.0; 2]; 2], rate: PI / self.moments as f64, way }
    }

    fn world(&self, place: [f64; 2], moment: usize) -> [f64; 2] {
        self.camera.at(moment as f64).inverse().at(place[0], place[1])
    }

    fn shape(&mut self, size: f64) -> Shape {
        let kind = [Kind::Blob, Kind::Blob, Kind::Ellipse, Kind::Rectangle][self.random.below(4)];
        let radius = self.random.uniform(0.8, 1.0) * size * self.radius;
        Shape::draw(self.random, kind, radius)
    }

    /// A body with two legs and an arm.
    fn limbs(&mut self) -> Vec<Part> {
        let length = self.random.uniform(0.85, 1.0) * self.radius;
        let rate = 2.0 * PI / self.random.uniform(12.0, 18.0);
        let phase = self.random.uniform(0.0, 2.0 * PI);
        let amplitude = self.random.uniform(0.35, 0.6);
        let upright = |radius: f64, ratio: f64| Shape::oriented(Kind::Ellipse, radius * length, [0.0, 1.0], ratio);
        let limb = |joint: [f64; 2], phase: f64| Part {
            shape: upright(0.45, 2.6),
            joint: joint.map(|v| v * length),
            arm: [0.0, 0.5 * length],
            swing: [amplitude, rate, phase],
        };
        let body = Part::body(upright(0.72, 1.7));
        vec![limb([-0.2, 0.5], phase), limb([0.2, 0.5], phase + PI), limb([0.45, -0.5], phase + 0.5 * PI), body]
    }

    /// A unit vector at a random angle below `range`.
    fn direction(&mut self, range: f64) -> [f64; 2] {
        let angle = self.random.uniform(0.0, range);
        [libm::cos(angle), libm::sin(angle)]
    }

    /// To the left or to the right, up to `tilt` radians up or down.
    fn along(&mut self, speed: f64, tilt: f64) -> [f64; 2] {
        let tilt = self.random.uniform(-tilt, tilt);
        let side = if self.random.unit() < 0.5 { speed } else { -speed };
        [side * libm::cos(tilt), speed * libm::sin(tilt)]
    }
}
