//! Random numbers from a seed (SplitMix64).

/// Stream of random numbers.
pub struct Chance(u64);

impl Chance {
    /// Creates the stream of an input by its seed, surface and number.
    pub fn new(seed: u64, surface: usize, number: u64) -> Self {
        let mut chance = Self(seed);
        chance.0 = chance.number() ^ surface as u64;
        chance.0 = chance.number() ^ number;
        chance
    }

    /// Returns any number.
    pub fn number(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a number below a limit; 0 if there is none.
    pub fn below(&mut self, limit: usize) -> usize {
        if limit == 0 { 0 } else { (self.number() % limit as u64) as usize }
    }

    /// Returns true with a probability of `often` percent.
    pub fn percent(&mut self, often: usize) -> bool {
        self.below(100) < often
    }

    /// Returns one of several values.
    pub fn one<'a, T: ?Sized>(&mut self, of: &[&'a T]) -> &'a T {
        of[self.below(of.len())]
    }

    /// Returns a number of repetitions: 1, seldom up to 6.
    pub fn times(&mut self) -> usize {
        let mut times = 1;
        while times < 6 && self.percent(40) {
            times += 1;
        }
        times
    }
}
