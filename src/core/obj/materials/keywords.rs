//! The keywords of material libraries.

/// Keywords that programs write for every material but shading doesn't use. Warnings about them would hide others.
pub(super) const IGNORED: [&str; 2] = ["ka", "sharpness"];

/// The keywords of the format and its common extensions, in lower case. Warnings quote no others: an OBJ can name
/// any file as a library, and its content must not be shown.
pub(super) const KEYWORDS: [&str; 45] = [
    "ka",
    "kd",
    "ks",
    "ke",
    "km",
    "tf",
    "tr",
    "d",
    "ns",
    "ni",
    "illum",
    "sharpness",
    "map_ka",
    "map_kd",
    "map_ks",
    "map_ke",
    "map_ns",
    "map_ni",
    "map_d",
    "map_tr",
    "map_bump",
    "map_disp",
    "map_refl",
    "map_norm",
    "map_aat",
    "bump",
    "disp",
    "decal",
    "refl",
    "norm",
    "pr",
    "pm",
    "ps",
    "pc",
    "pcr",
    "aniso",
    "anisor",
    "map_pr",
    "map_pm",
    "map_ps",
    "map_pc",
    "map_pcr",
    "map_ao",
    "newmtl",
    "map_opacity",
];

/// The keywords of properties that are numbers, in lower case.
pub(super) const VALUES: [&str; 10] =
    ["kd", "ks", "ke", "tf", "ns", "d", "tr", "illum", "pr", "pm"];

/// The form that a value must have, as part of a warning, for a keyword of [`VALUES`].
pub(super) fn expected_value(keyword: &str) -> &'static str {
    match keyword.to_ascii_lowercase().as_str() {
        "kd" | "ks" | "ke" | "tf" => "a colour is one or three numbers that aren't negative",
        "illum" => "illum is a whole number from 0 to 10",
        _ => "its value is a number that isn't negative",
    }
}
