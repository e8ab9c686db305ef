//! Maximum flow on the 4-connected grid by the search trees of Boykov and Kolmogorov (PAMI 26(9), 2004).
//!
//! Neighbours are implicit: node p has edges to p ± 1 and p ± stride in a grid with one more node on each side, whose
//! edges have no capacity, so that borders need no special case. Two trees grow from source and sink until they meet, the flow
//! along the path is augmented until an edge is saturated, and the nodes cut off look for another parent.

use std::collections::VecDeque;

/// Directions right, left, down, up; `d ^ 1` is the opposite one.
const RIGHT: usize = 0;
const DOWN: usize = 2;
/// Values of `parent` other than a direction.
const TERMINAL: u8 = 4;
const ORPHAN: u8 = 5;
const FREE: u8 = 6;
/// Augmentations per node before the search is given up; real problems stay below 2.
const PATHS_PER_NODE: usize = 64;

/// A flow problem on a grid; build with [`reset`](Self::reset), [`add_terminal`](Self::add_terminal),
/// [`set_right`](Self::set_right), [`set_down`](Self::set_down), then [`run`](Self::run).
pub(super) struct GridFlow {
    width: usize,
    height: usize,
    offsets: [isize; 4],
    /// Residual capacity of the edge in each direction.
    residual: Vec<[f32; 4]>,
    /// Residual capacity from the source (> 0) or to the sink (< 0).
    terminal: Vec<f32>,
    parent: Vec<u8>,
    in_sink_tree: Vec<bool>,
    /// Distance to the terminal, valid at the time it was stamped.
    distance: Vec<u32>,
    stamp: Vec<u32>,
    time: u32,
    active: VecDeque<u32>,
    queued: Vec<bool>,
    orphans: VecDeque<u32>,
}

impl GridFlow {
    pub(super) fn new(width: usize, height: usize) -> Self {
        let stride = width + 2;
        let nodes = stride * (height + 2);
        GridFlow {
            width,
            height,
            offsets: [1, -1, stride as isize, -(stride as isize)],
            residual: vec![[0.0; 4]; nodes],
            terminal: vec![0.0; nodes],
            parent: vec![FREE; nodes],
            in_sink_tree: vec![false; nodes],
            distance: vec![0; nodes],
            stamp: vec![0; nodes],
            time: 0,
            active: VecDeque::new(),
            queued: vec![false; nodes],
            orphans: VecDeque::new(),
        }
    }

    /// Removes all capacities.
    pub(super) fn reset(&mut self) {
        self.residual.fill([0.0; 4]);
        self.terminal.fill(0.0);
    }

    fn node(&self, x: usize, y: usize) -> usize {
        (y + 1) * (self.width + 2) + x + 1
    }

    /// Adds capacity from the source to pixel (x, y) (positive) or from it to the sink (negative).
    pub(super) fn add_terminal(&mut self, x: usize, y: usize, capacity: f32) {
        let p = self.node(x, y);
        self.terminal[p] += capacity;
    }

    /// Capacity from (x, y) to its right neighbour.
    pub(super) fn set_right(&mut self, x: usize, y: usize, capacity: f32) {
        let p = self.node(x, y);
        self.residual[p][RIGHT] = capacity;
    }

    /// Capacity from (x, y) to its lower neighbour.
    pub(super) fn set_down(&mut self, x: usize, y: usize, capacity: f32) {
        let p = self.node(x, y);
        self.residual[p][DOWN] = capacity;
    }

    /// Whether pixel (x, y) is on the sink's side of the minimum cut.
    pub(super) fn is_sink_side(&self, x: usize, y: usize) -> bool {
        let p = self.node(x, y);
        self.parent[p] != FREE && self.in_sink_tree[p]
    }

    #[inline(always)]
    fn towards(&self, p: usize, direction: usize) -> usize {
        p.wrapping_add_signed(self.offsets[direction])
    }

    /// Residual capacity between p and its neighbour in the direction in which flow runs in p's tree if the neighbour is
    /// its child: away from the source, towards the sink.
    #[inline(always)]
    fn open_to_child(&self, p: usize, direction: usize, sink: bool) -> bool {
        if sink {
            self.residual[self.towards(p, direction)][direction ^ 1] > 0.0
        } else {
            self.residual[p][direction] > 0.0
        }
    }

    fn activate(&mut self, p: usize) {
        if !self.queued[p] {
            self.queued[p] = true;
            self.active.push_back(p as u32);
        }
    }

    /// Finds the maximum flow. False if it was given up; the sides are then a cut, but perhaps not the smallest.
    pub(super) fn run(&mut self) -> bool {
        self.active.clear();
        self.orphans.clear();
        self.queued.fill(false);
        self.stamp.fill(0);
        self.time = 0;
        for p in 0..self.terminal.len() {
            self.parent[p] = FREE;
            if self.terminal[p] != 0.0 {
                self.in_sink_tree[p] = self.terminal[p] < 0.0;
                self.parent[p] = TERMINAL;
                self.distance[p] = 1;
                self.activate(p);
            }
        }
        let mut budget = PATHS_PER_NODE * self.width * self.height;
        while let Some(p) = self.active.pop_front() {
            let p = p as usize;
            self.queued[p] = false;
            // Continues with the same node until it finds no more: its neighbourhood is in the cache.
            while self.parent[p] != FREE {
                let Some((tail, direction)) = self.grow(p) else { break };
                if budget == 0 {
                    return false;
                }
                budget -= 1;
                self.time += 1;
                self.augment(tail, direction);
                while let Some(orphan) = self.orphans.pop_front() {
                    self.adopt(orphan as usize);
                }
            }
        }
        true
    }

    /// Takes free neighbours of p into its tree; stops at an edge from the source's tree into the sink's.
    fn grow(&mut self, p: usize) -> Option<(usize, usize)> {
        let sink = self.in_sink_tree[p];
        for direction in 0..4 {
            if !self.open_to_child(p, direction, sink) {
                continue;
            }
            let q = self.towards(p, direction);
            if self.parent[q] == FREE {
                self.in_sink_tree[q] = sink;
                self.parent[q] = (direction ^ 1) as u8;
                self.stamp[q] = self.stamp[p];
                self.distance[q] = self.distance[p] + 1;
                self.activate(q);
            } else if self.in_sink_tree[q] != sink {
                return Some(if sink { (q, direction ^ 1) } else { (p, direction) });
            } else if self.stamp[q] <= self.stamp[p] && self.distance[q] > self.distance[p] + 1 {
                // A shorter way to the terminal.
                self.parent[q] = (direction ^ 1) as u8;
                self.stamp[q] = self.stamp[p];
                self.distance[q] = self.distance[p] + 1;
            }
        }
        None
    }

    /// Augments the flow along the path through the edge that leaves `tail` in `direction`.
    fn augment(&mut self, tail: usize, direction: usize) {
        let head = self.towards(tail, direction);
        let mut bottleneck = self.residual[tail][direction];
        let mut p = tail;
        while self.parent[p] < TERMINAL {
            let d = usize::from(self.parent[p]);
            p = self.towards(p, d);
            bottleneck = bottleneck.min(self.residual[p][d ^ 1]);
        }
        bottleneck = bottleneck.min(self.terminal[p]);
        let mut p = head;
        while self.parent[p] < TERMINAL {
            let d = usize::from(self.parent[p]);
            bottleneck = bottleneck.min(self.residual[p][d]);
            p = self.towards(p, d);
        }
        bottleneck = bottleneck.min(-self.terminal[p]);

        self.residual[tail][direction] -= bottleneck;
        self.residual[head][direction ^ 1] += bottleneck;
        let mut p = tail;
        while self.parent[p] < TERMINAL {
            let d = usize::from(self.parent[p]);
            let q = self.towards(p, d);
            self.residual[p][d] += bottleneck;
            self.residual[q][d ^ 1] -= bottleneck;
            if self.residual[q][d ^ 1] <= 0.0 {
                self.cut_off_front(p);
            }
            p = q;
        }
        self.terminal[p] -= bottleneck;
        if self.terminal[p] <= 0.0 {
            self.cut_off_front(p);
        }
        let mut p = head;
        while self.parent[p] < TERMINAL {
            let d = usize::from(self.parent[p]);
            let q = self.towards(p, d);
            self.residual[q][d ^ 1] += bottleneck;
            self.residual[p][d] -= bottleneck;
            if self.residual[p][d] <= 0.0 {
                self.cut_off_front(p);
            }
            p = q;
        }
        self.terminal[p] += bottleneck;
        if self.terminal[p] >= 0.0 {
            self.cut_off_front(p);
        }
    }

    fn cut_off_front(&mut self, p: usize) {
        self.parent[p] = ORPHAN;
        self.orphans.push_front(p as u32);
    }

    /// Finds the orphan a new parent in its tree, the one nearest to the terminal, or frees it and orphans its children.
    fn adopt(&mut self, p: usize) {
        let sink = self.in_sink_tree[p];
        let (mut nearest, mut best) = (u32::MAX, FREE);
        for direction in 0..4 {
            let q = self.towards(p, direction);
            if self.parent[q] == FREE || self.in_sink_tree[q] != sink || !self.open_to_child(q, direction ^ 1, sink) {
                continue;
            }
            let Some(distance) = self.distance_to_terminal(q) else { continue };
            if distance < nearest {
                (nearest, best) = (distance, direction as u8);
            }
        }
        if best != FREE {
            self.parent[p] = best;
            self.stamp[p] = self.time;
            self.distance[p] = nearest + 1;
            return;
        }
        for direction in 0..4 {
            let q = self.towards(p, direction);
            if self.parent[q] == FREE || self.in_sink_tree[q] != sink {
                continue;
            }
            if self.open_to_child(q, direction ^ 1, sink) {
                self.activate(q);
            }
            if self.parent[q] == (direction ^ 1) as u8 {
                self.parent[q] = ORPHAN;
                self.orphans.push_back(q as u32);
            }
        }
        self.parent[p] = FREE;
    }

    /// Steps from q to its terminal, none if the path ends at an orphan. Stamps the path, so that it is walked once.
    fn distance_to_terminal(&mut self, q: usize) -> Option<u32> {
        let mut steps = 0;
        let mut p = q;
        let total = loop {
            if self.stamp[p] == self.time {
                break steps + self.distance[p];
            }
            steps += 1;
            match self.parent[p] {
                TERMINAL => {
                    self.stamp[p] = self.time;
                    self.distance[p] = 1;
                    break steps;
                }
                ORPHAN | FREE => return None,
                d => p = self.towards(p, usize::from(d)),
            }
        };
        let (mut p, mut remaining) = (q, total);
        while self.stamp[p] != self.time {
            self.stamp[p] = self.time;
            self.distance[p] = remaining;
            remaining -= 1;
            p = self.towards(p, usize::from(self.parent[p]));
        }
        Some(total)
    }
}
