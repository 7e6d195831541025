//! Tables as lines of monospaced text: aligned in the first frame, and selectable.

use egui::RichText;

/// Shows a table. The first column is aligned left, the others right.
pub fn table_ui<const N: usize>(
    ui: &mut egui::Ui,
    columns: [&str; N],
    rows: impl Iterator<Item = [String; N]>,
) {
    let header = columns.map(str::to_owned);
    let cells: Vec<[String; N]> = std::iter::once(header).chain(rows).collect();
    let widths = widths(&cells);
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 1.0;
        for (row, cells) in cells.iter().enumerate() {
            let text = RichText::new(aligned(cells, &widths))
                .monospace()
                .size(10.5);
            let text = if row == 0 { text.strong() } else { text };
            ui.add(egui::Label::new(text).extend());
        }
    });
}

/// Width of each column in characters.
pub fn widths<const N: usize>(cells: &[[String; N]]) -> [usize; N] {
    let mut widths = [0; N];
    for row in cells {
        for (width, cell) in widths.iter_mut().zip(row) {
            *width = (*width).max(cell.chars().count());
        }
    }
    widths
}

/// The cells of a row, padded to the columns' widths.
pub fn aligned<const N: usize>(cells: &[String; N], widths: &[usize; N]) -> String {
    let mut text = String::new();
    for (column, (cell, &width)) in cells.iter().zip(widths).enumerate() {
        if column == 0 {
            text += &format!("{cell:<width$}");
        } else {
            text += &format!(" {cell:>width$}");
        }
    }
    text
}

/// The text of a cell without a value.
pub fn dash() -> String {
    "–".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_longest_cell() {
        let cells = [["", "t"], ["exact", "1.5"], ["Möller", "–"]];
        let cells = cells.map(|row| row.map(str::to_owned));
        let widths = widths(&cells);
        let lines = cells.each_ref().map(|row| aligned(row, &widths));
        assert_eq!(lines, ["         t", "exact  1.5", "Möller   –"]);
    }
}
