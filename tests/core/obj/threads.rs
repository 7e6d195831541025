//! The result doesn't depend on the number of threads.

use super::{LENIENT, STRICT, parse};
use hitscope_core::obj::LoadOptions;
use hitscope_core::random::Random;
use rayon::ThreadPoolBuilder;
use std::fmt::Write as _;

/// A file of several chunks with everything that is resolved across them: absolute and relative indices, names, smoothing
/// groups, elements of all kinds, and unknown statements.
fn file(random: &mut Random, has_faults: bool) -> String {
    let mut text = String::new();
    let mut vertices: usize = 0;
    while text.len() < 1_500_000 {
        for _ in 0..4 {
            let [x, y, z] = [(); 3].map(|()| 1000.0 * random.unit());
            writeln!(
                text,
                "v {x:.3} {y:.3} {z:.3}\nvt {x:.1} {y:.1}\nvn {z:.1} 1 0"
            )
            .expect("memory");
        }
        vertices += 4;
        let back = |random: &mut Random| 1 + random.index(vertices.min(9000));
        match random.index(12) {
            0 => writeln!(
                text,
                "usemtl m{}\ng g{}",
                random.index(20),
                random.index(30)
            ),
            1 => writeln!(text, "s {}", random.index(3)),
            2 => writeln!(text, "l -1 -{}\np {}", back(random), back(random)),
            3 => writeln!(text, "curv {}", random.index(9)),
            4 if has_faults => writeln!(text, "f 1 2 {}\nf 1 2 0\nf 1 2", vertices + 1_000_000),
            5 if has_faults => writeln!(text, "f 1/-{}/0 2 3", vertices + 5),
            _ => Ok(()),
        }
        .expect("memory");
        let [a, b, c, d] = [(); 4].map(|()| back(random));
        writeln!(text, "f -{a} -{b} -{c}\nf {a}/{b} {b}/{c} {c}/{d} {d}/{a}").expect("memory");
        writeln!(text, "f -1//-{a} -2//{b} -3//-1").expect("memory");
    }
    text
}

fn load(text: &str, options: LoadOptions, threads: usize) -> String {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.expect("threads");
    let result = pool.install(|| parse(text.as_bytes(), options));
    match result {
        Ok(loaded) => format!(
            "{:?} {:?} {:?}",
            loaded.mesh, loaded.report.warnings, loaded.report.max_rounding
        ),
        Err(error) => error.to_string(),
    }
}

#[test]
fn one_thread_and_several_give_the_same_mesh_warnings_and_errors() {
    let mut random = Random::new(12);
    for (has_faults, options) in [(false, STRICT), (true, LENIENT), (true, STRICT)] {
        let text = file(&mut random, has_faults);
        let one = load(&text, options, 1);
        assert_eq!(
            one.starts_with("TriangleMesh"),
            !has_faults || options == LENIENT
        );
        for threads in [2, 5] {
            assert!(load(&text, options, threads) == one, "{threads} threads");
        }
    }
}

#[test]
fn a_warning_names_the_first_line_of_its_kind() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99\nf 1 2 3\nf 0 1 2\n";
    let loaded = parse(text.as_bytes(), LENIENT).expect("a face is good");
    assert_eq!(
        super::warnings(&loaded),
        ["line 4: 2 faces dropped: an index is out of range, or there are too few corners"]
    );
}
