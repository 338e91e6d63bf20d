//! Files of Gauss coefficients of each kind, with other lines, numbers or bytes.

use super::structures;
use crate::chance::Chance;

const SHC: &str = "# a comment\n1 2 3 2 1 2020.0 2030.0\n 2020.0 2025.0 2030.0\n1 0 -29441.46 -29403.41 -29350.0\n\
    1 1 -1501.77 -1451.37 -1410.3\n1 -1 4795.99 4653.35 4545.5\n2 0 -2445.88 -2499.78 -2556.2\n2 1 3012.2 2981.96 2950.9\n\
    2 -1 -2845.41 -2991.72 -3133.6\n2 2 1676.35 1676.85 1648.7\n2 -2 -642.17 -734.62 -814.2\n";
const WORLD_MODEL: &str = "    2025.0            WMM-2025     11/13/2024\n  1  0  -29351.8       0.0       12.0        0.0\n\
    1  1   -1410.8    4545.4        9.7      -21.5\n9999999999999999999999999\n9999999999999999999999999\n";
const BLOCKS: &str = "   DGRF2020  2020.00  1  0  0 2020.00 2025.00   -1.0  600.0    DGRF2020   0\n\
    1  0 -29403.41    0.0     0.0    0.0   DGRF2020   1\n1  1  -1451.37 4653.35    0.0    0.0   DGRF2020   2\n\
    IGRF2025  2025.00  2  1  0 2025.00 2030.00   -1.0  600.0    IGRF2025   3\n\
    1  0 -29350.0     0.0    12.6    0.0   IGRF2025   4\n1  1  -1410.3  4545.5    10.0  -21.5   IGRF2025   5\n\
    2  0  -2556.2     0.0   -11.2    0.0   IGRF2025   6\n2  1   2950.9 -3133.6    -5.3  -27.3   IGRF2025   7\n\
    2  2   1648.7  -814.2    -8.3  -11.1   IGRF2025   8\n";

const COLUMNS: &str = "# a comment\nc/s deg ord IGRF IGRF SV\ng/h n m 2020.0 2025.0 2025-30\ng 1 0 -29403.41 -29350.0 12.6\n\
    g 1 1 -1451.37 -1410.3 10.0\nh 1 1 4653.35 4545.5 -21.5\n";

/// Returns the name and the bytes of a file; the kinds differ in their first lines, and not in their names.
pub fn file(chance: &mut Chance) -> (&'static str, Vec<u8>) {
    let (name, text) =
        [("f.shc", SHC), ("f.COF", WORLD_MODEL), ("f.COF", BLOCKS), ("f.txt", COLUMNS)][chance.below(4)];
    let other = chance.one(&[SHC, WORLD_MODEL, BLOCKS, COLUMNS]);
    match chance.below(8) {
        0 => (name, text.into()),
        // Lines of one kind within another.
        1 => (name, structures::spoilt(&format!("{text}{other}"), chance)),
        _ => (name, structures::spoilt(text, chance)),
    }
}
