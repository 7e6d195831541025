//! Integration tests of hitscope-lab.

// What the commands print, and what they refuse.
mod commands;
// Inspection of single rays against the exact answer.
mod inspection;
