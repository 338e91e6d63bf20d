//! Tests of the attitude filter: against forty digits, against exact laws, and by bits against the matrix library.

mod bits;
mod forty_digits;
mod gate;
mod history;
mod matrix_filter;
mod vectors;
