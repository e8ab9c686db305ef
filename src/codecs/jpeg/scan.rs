//! Whether the scans of a JPEG file contain all blocks of the image: their codes are read and discarded (ITU-T T.81, F.2.2 and G.2).
//! Decoders do not report a scan that is truncated.

/// Bytes that may lie between the last code of a scan and the next marker.
const SPARE: usize = 8;

/// Whether all scans are complete. True for files that are not Huffman-coded, which the decoder rejects.
pub(super) fn are_whole(file: &[u8]) -> bool {
    let mut image = Image::default();
    let mut at = 2;
    while let Some(&[0xff, marker]) = file.get(at..).and_then(|rest| rest.first_chunk()) {
        let length = match marker {
            0xff => {
                at += 1;
                continue;
            }
            0xd9 => return true,
            1 | 0xd0..=0xd8 => 0,
            _ => file
                .get(at + 2..)
                .and_then(|rest| rest.first_chunk())
                .map_or(2, |&pair| usize::from(u16::from_be_bytes(pair))),
        };
        let Some(segment) = file.get((at + 4).min(at + 2 + length)..at + 2 + length) else { return false };
        at += 2 + length;
        let known = match marker {
            0xc0..=0xc2 => image.frame(segment, marker == 0xc2),
            0xc3 | 0xc5..=0xc7 | 0xc9..=0xcf => return true,
            0xc4 => image.tables(segment),
            0xdd => image.interval(segment),
            0xda => {
                let mut bits = Bits { bytes: file, at, held: 0, count: 0 };
                let whole = image.scan(segment, &mut bits);
                at = bits.marker();
                // Two scans, one without its end and the other without its beginning, may look like one. Other files have nothing to spare.
                whole.filter(|()| !image.progressive || at - bits.at <= SPARE)
            }
            _ => Some(()),
        };
        if known.is_none() {
            return false;
        }
        // A few bytes between segments are skipped, as by decoders.
        while file.get(at).is_some_and(|&byte| byte != 0xff) {
            at += 1;
        }
    }
    false
}

/// The bits of a scan, up to its next marker.
struct Bits<'a> {
    bytes: &'a [u8],
    at: usize,
    held: u32,
    count: u32,
}

impl Bits<'_> {
    fn bit(&mut self) -> Option<u32> {
        if self.count == 0 {
            self.held = u32::from(*self.bytes.get(self.at)?);
            if self.held == 0xff {
                (*self.bytes.get(self.at + 1)? == 0).then(|| self.at += 1)?;
            }
            self.at += 1;
            self.count = 8;
        }
        self.count -= 1;
        Some(self.held >> self.count & 1)
    }

    fn bits(&mut self, count: u32) -> Option<u32> {
        (0..count).try_fold(0, |value, _| Some(value << 1 | self.bit()?))
    }

    /// Skips the marker of a restart, which must have this number.
    fn restart(&mut self, number: usize) -> Option<()> {
        self.count = 0;
        self.at = self.marker();
        (self.bytes.get(self.at + 1) == Some(&(0xd0 | (number % 8) as u8))).then(|| self.at += 2)
    }

    /// Where the next marker is.
    fn marker(&self) -> usize {
        let rest = self.bytes.get(self.at..).unwrap_or_default();
        let step = rest.windows(2).position(|pair| pair[0] == 0xff && pair[1] != 0 && pair[1] != 0xff);
        self.at + step.unwrap_or(rest.len())
    }
}

/// A code, by the length of its words: the first word, the number of words, and the index of their first value.
#[derive(Clone, Default)]
struct Table {
    lengths: [(u32, u32, usize); 16],
    values: Vec<u8>,
}

impl Table {
    fn value(&self, bits: &mut Bits<'_>) -> Option<u32> {
        let mut word = 0;
        for (first, count, from) in self.lengths {
            word = word << 1 | bits.bit()?;
            if word.wrapping_sub(first) < count {
                return self.values.get(from + (word - first) as usize).map(|&value| u32::from(value));
            }
        }
        None
    }
}

#[derive(Default)]
struct Component {
    id: u8,
    /// Blocks of a unit of a scan of all components, across and down.
    unit: (usize, usize),
    /// Number of blocks of the component alone, and of all its units.
    blocks: (usize, usize),
    stride: usize,
    /// For each block, one bit per coefficient that is not 0; a scan that refines it has one bit for each of these.
    filled: Vec<u64>,
}

#[derive(Default)]
struct Image {
    progressive: bool,
    /// Units of a scan of more than one component, across and down.
    units: (usize, usize),
    components: Vec<Component>,
    /// Of first coefficients, then of the others.
    tables: [[Table; 4]; 2],
    interval: usize,
}

impl Image {
    fn frame(&mut self, segment: &[u8], progressive: bool) -> Option<()> {
        let &[_, high, low, wide, narrow, _, ref parts @ ..] = segment else { return None };
        let height = usize::from(u16::from_be_bytes([high, low]));
        let width = usize::from(u16::from_be_bytes([wide, narrow]));
        let parts = || {
            parts.as_chunks::<3>().0.iter().map(|&[id, unit, _]| (id, (usize::from(unit >> 4), usize::from(unit & 15))))
        };
        let most = parts().fold((1, 1), |(x, y), (_, unit)| (unit.0.max(x), unit.1.max(y)));
        self.progressive = progressive;
        self.units = (width.div_ceil(8 * most.0), height.div_ceil(8 * most.1));
        self.components = parts()
            .map(|(id, unit)| {
                let blocks = ((width * unit.0).div_ceil(8 * most.0), (height * unit.1).div_ceil(8 * most.1));
                let stride = self.units.0 * unit.0;
                let filled = if progressive { vec![0; stride * self.units.1 * unit.1] } else { Vec::new() };
                Component { id, unit, blocks, stride, filled }
            })
            .collect();
        Some(())
    }

    fn tables(&mut self, mut segment: &[u8]) -> Option<()> {
        while let [which, rest @ ..] = segment {
            let (counts, rest) = rest.split_first_chunk::<16>()?;
            let mut table = Table::default();
            let (mut word, mut from) = (0, 0);
            for (length, &count) in table.lengths.iter_mut().zip(counts) {
                word <<= 1;
                *length = (word, u32::from(count), from);
                word += u32::from(count);
                from += usize::from(count);
            }
            table.values = rest.get(..from)?.to_vec();
            segment = &rest[from..];
            *self.tables.get_mut(usize::from(which >> 4))?.get_mut(usize::from(which & 15))? = table;
        }
        Some(())
    }

    fn interval(&mut self, segment: &[u8]) -> Option<()> {
        self.interval = usize::from(u16::from_be_bytes(*segment.first_chunk()?));
        Some(())
    }

    fn scan(&mut self, segment: &[u8], bits: &mut Bits<'_>) -> Option<()> {
        let (&count, rest) = segment.split_first()?;
        let parts = rest.get(..2 * usize::from(count))?.as_chunks::<2>().0;
        let &[first, last, steps] = rest.get(2 * usize::from(count)..)?.first_chunk()?;
        let coder = Coder {
            progressive: self.progressive,
            first: u32::from(first),
            last: u32::from(last).min(63),
            refines: steps >> 4 > 0,
        };
        let mut chosen = Vec::new();
        for &[id, tables] in parts {
            let at = self.components.iter().position(|component| component.id == id)?;
            let table = |kind: usize, which: u8| self.tables[kind].get(usize::from(which)).cloned();
            chosen.push((at, table(0, tables >> 4)?, table(1, tables & 15)?));
        }
        let alone = chosen.len() == 1;
        let (across, down) = match &chosen[..] {
            [(at, ..)] => self.components[*at].blocks,
            _ => self.units,
        };
        let mut run = 0;
        for unit in 0..across * down {
            if self.interval > 0 && unit > 0 && unit % self.interval == 0 {
                bits.restart(unit / self.interval - 1)?;
                run = 0;
            }
            let (column, row) = (unit % across, unit / across);
            for (at, direct, alternating) in &chosen {
                let component = &mut self.components[*at];
                let (wide, high) = if alone { (1, 1) } else { component.unit };
                for block in 0..wide * high {
                    let place = (row * high + block / wide) * component.stride + column * wide + block % wide;
                    let mut unused = 0;
                    let filled = component.filled.get_mut(place).unwrap_or(&mut unused);
                    coder.block(bits, direct, alternating, filled, &mut run)?;
                }
            }
        }
        Some(())
    }
}

/// Which coefficients of each block a scan has.
struct Coder {
    progressive: bool,
    first: u32,
    last: u32,
    /// Whether it refines known coefficients by one bit.
    refines: bool,
}

impl Coder {
    /// `run` is the number of following blocks without further coefficients.
    fn block(
        &self,
        bits: &mut Bits<'_>,
        direct: &Table,
        alternating: &Table,
        filled: &mut u64,
        run: &mut u32,
    ) -> Option<()> {
        if !self.progressive {
            let size = direct.value(bits)?;
            bits.bits(size)?;
            return self.first_bits(bits, alternating, (1, 63), filled, run);
        }
        match (self.first, self.refines) {
            (0, true) => bits.bit().map(|_| ()),
            (0, false) => {
                let size = direct.value(bits)?;
                bits.bits(size).map(|_| ())
            }
            (first, false) => self.first_bits(bits, alternating, (first, self.last), filled, run),
            (first, true) => self.next_bits(bits, alternating, (first, self.last), filled, run),
        }
    }

    fn first_bits(
        &self,
        bits: &mut Bits<'_>,
        table: &Table,
        (first, last): (u32, u32),
        filled: &mut u64,
        run: &mut u32,
    ) -> Option<()> {
        if *run > 0 {
            *run -= 1;
            return Some(());
        }
        let mut at = first;
        while at <= last {
            let value = table.value(bits)?;
            let (zeros, size) = (value >> 4, value & 15);
            if size == 0 && zeros < 15 {
                *run = if self.progressive { (1 << zeros) + bits.bits(zeros)? - 1 } else { 0 };
                return Some(());
            }
            at += zeros;
            bits.bits(size)?;
            if size > 0 && at < 64 {
                *filled |= 1 << at;
            }
            at += 1;
        }
        Some(())
    }

    fn next_bits(
        &self,
        bits: &mut Bits<'_>,
        table: &Table,
        (first, last): (u32, u32),
        filled: &mut u64,
        run: &mut u32,
    ) -> Option<()> {
        let mut at = first;
        while *run == 0 && at <= last {
            let value = table.value(bits)?;
            let (mut zeros, size) = (value >> 4, value & 15);
            if size == 0 && zeros < 15 {
                *run = (1 << zeros) + bits.bits(zeros)?;
                break;
            }
            bits.bits(size)?;
            while at <= last {
                if *filled >> at & 1 == 1 {
                    bits.bit()?;
                } else if zeros == 0 {
                    if size > 0 {
                        *filled |= 1 << at;
                    }
                    at += 1;
                    break;
                } else {
                    zeros -= 1;
                }
                at += 1;
            }
        }
        if *run > 0 {
            for known in at..=last {
                if *filled >> known & 1 == 1 {
                    bits.bit()?;
                }
            }
            *run -= 1;
        }
        Some(())
    }
}
