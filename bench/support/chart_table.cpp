// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/chart_table.h"

#include "meniscus/core/error.h"
#include "meniscus/core/version.h"
#include "meniscus/io/write_file_atomically.h"
#include "support/process.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>

namespace meniscus::bench {
namespace {

std::string text_of(const Cell& cell) {
  if (const double* number = std::get_if<double>(&cell)) return fmt::format("{:.6g}", *number);
  return std::get<std::string>(cell);
}

using Json = nlohmann::ordered_json;

/// Whole numbers without a point; JSON has no NaN.
Json json_of(const Cell& cell) {
  const double* number = std::get_if<double>(&cell);
  if (!number) return std::get<std::string>(cell);
  if (!std::isfinite(*number)) return nullptr;
  const double rounded = std::stod(text_of(cell));
  if (rounded == std::floor(rounded) && std::abs(rounded) < 1e15) return static_cast<std::int64_t>(rounded);
  return rounded;
}

/// Rows from `first` on that agree in the columns before `fold_from`, as one; `first` is then the next.
Json folded_row(const std::vector<std::vector<Cell>>& rows, std::size_t& first, std::size_t fold_from) {
  const std::vector<Cell>& row = rows[first];
  std::size_t end = first + 1;
  const auto same = [&](const std::vector<Cell>& other) {
    return std::equal(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(fold_from), other.begin());
  };
  while (fold_from > 0 && end < rows.size() && same(rows[end])) ++end;
  Json cells = Json::array();
  for (std::size_t c = 0; c < row.size(); ++c) {
    Json list = Json::array();
    for (std::size_t r = first; r < end; ++r) list.push_back(json_of(rows[r][c]));
    const bool is_one = std::all_of(list.begin(), list.end(), [&](const Json& cell) { return cell == list[0]; });
    cells.push_back(is_one ? list[0] : list);
  }
  first = end;
  return cells;
}

std::string line_of(const std::vector<Cell>& row) {
  std::vector<std::string> cells;
  for (const Cell& cell : row) cells.push_back(text_of(cell));
  return fmt::format("{}", fmt::join(cells, ","));
}

}  // namespace

ChartTable::ChartTable(std::string name, std::string title, std::vector<std::string> columns)
    : name_(std::move(name)), title_(std::move(title)), columns_(std::move(columns)) {
  fmt::print("\n{}: {}\n{}\n", name_, title_, fmt::join(columns_, ","));
}

void ChartTable::add(std::vector<Cell> row) {
  if (row.size() != columns_.size())
    throw UsageError(fmt::format("{}: {} cells for {} columns", name_, row.size(), columns_.size()));
  for (const Cell& cell : row)
    if (const std::string text = text_of(cell); text.find(',') != std::string::npos)
      throw UsageError(fmt::format("{}: a comma in the cell \"{}\"", name_, text));
  fmt::print("{}\n", line_of(row));
  std::fflush(stdout);
  rows_.push_back(std::move(row));
}

void ChartTable::note(std::string text) {
  fmt::print("{}\n", text);
  std::fflush(stdout);
  notes_.push_back(std::move(text));
}

void ChartTable::write(const std::filesystem::path& directory) const {
  std::string csv = fmt::format("# {}\n# meniscus {}, {}, {}\n", title_, version(), machine(), today());
  for (const std::string& text : notes_) csv += fmt::format("# {}\n", text);
  csv += fmt::format("{}\n", fmt::join(columns_, ","));
  for (const auto& row : rows_) csv += line_of(row) + '\n';
  Json json{{"title", title_}, {"version", version()}, {"machine", machine()},
            {"date", today()}, {"notes", notes_},      {"columns", columns_}};
  if (fold_from_ > 0) json["lists_from"] = columns_[fold_from_];
  std::string rows;  // one a line
  for (std::size_t r = 0; r < rows_.size();)
    rows += (rows.empty() ? "" : ",\n") + folded_row(rows_, r, fold_from_).dump();
  std::string head = json.dump();
  head.pop_back();  // the brace
  std::filesystem::create_directories(directory);
  write_file_atomically(directory / (name_ + ".csv"), csv);
  write_file_atomically(directory / (name_ + ".json"), head + ",\n\"rows\": [\n" + rows + "\n]}\n");
}

bool draw(const std::string& name, const std::filesystem::path& directory) {
  if (!is_installed("gnuplot")) {
    fmt::print("{}.svg: not drawn, gnuplot is not installed\n", name);
    return false;
  }
  const Finished run =
      run_program({"gnuplot", "-e",
                   fmt::format("data='{}'; style='{}/bench/charts/style.gp'", directory.string(), MENISCUS_SOURCE_DIR),
                   fmt::format("{}/bench/charts/{}.gp", MENISCUS_SOURCE_DIR, name)},
                  directory);
  if (run.code != 0) throw NumericsError(fmt::format("gnuplot failed on {}: {}", name, run.output));
  fmt::print("{}\n", (directory / (name + ".svg")).string());
  return true;
}

std::string machine() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

}  // namespace meniscus::bench
