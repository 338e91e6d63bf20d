# Short names for what README and CI run.

check:
    cargo fmt --check
    cargo clippy --profile ci --workspace --all-targets -- -D warnings

quick:
    python3 tests/all.py --quick

test:
    python3 tests/all.py

bench:
    python3 benches/table.py

site:
    python3 site/build.py

wheel:
    pip wheel --no-deps -w dist .
