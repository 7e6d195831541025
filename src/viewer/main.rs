//! The `hitscope` binary; the library of the same name holds the code.

fn main() -> std::process::ExitCode {
    hitscope::cli::run()
}
