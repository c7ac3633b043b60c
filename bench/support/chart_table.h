// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace meniscus::bench {

/// One cell: a number (NaN: nothing measured) or a word.
using Cell = std::variant<double, std::string>;

/// The data of one chart. Rows are kept in the order in which they came.
class ChartTable {
 public:
  /// `name` is that of the files, `title` says in a sentence what was measured.
  ChartTable(std::string name, std::string title, std::vector<std::string> columns);

  /// One row; as many cells as columns. It is printed at once, so that a long run shows how far it is.
  void add(std::vector<Cell> row);

  /// A sentence that follows from the rows, such as a fitted exponent; it is printed, too.
  void note(std::string text);

  /// In JSON, successive rows that agree in the first columns, up to `column`, become one row: from `column` on, its
  /// cells are lists, or one value where all are the same. For large tables; nothing is lost.
  void fold_from(std::size_t column) { fold_from_ = column; }

  /// Writes name.csv (comment lines with title, then version, machine and date, then the notes; then the names of
  /// the columns) and name.json into the directory, both whole or not at all. Throws FileError.
  void write(const std::filesystem::path& directory) const;

  const std::string& name() const { return name_; }
  const std::vector<std::vector<Cell>>& rows() const { return rows_; }

 private:
  std::string name_, title_;
  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
  std::vector<std::string> notes_;
  std::size_t fold_from_ = 0;  ///< 0: rows stay as they are
};

/// Draws DIRECTORY/name.svg from DIRECTORY/name.csv with bench/charts/name.gp; says why not, if gnuplot is not
/// there. Returns whether it drew. Throws NumericsError if gnuplot fails.
bool draw(const std::string& name, const std::filesystem::path& directory);

std::string machine();  ///< the processor's name
std::string today();    ///< UTC, as 2026-01-31

}  // namespace meniscus::bench
