// SPDX-License-Identifier: GPL-3.0-or-later
#include "support/chart_table.h"

#include "meniscus/core/error.h"
#include "meniscus/core/version.h"
#include "meniscus/io/write_file_atomically.h"
#include "support/process.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

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
  nlohmann::ordered_json json{{"title", title_}, {"version", version()}, {"machine", machine()},
                              {"date", today()}, {"notes", notes_},      {"columns", columns_}};
  std::string rows;  // one a line
  for (const auto& row : rows_) {
    csv += line_of(row) + '\n';
    nlohmann::ordered_json cells = nlohmann::ordered_json::array();
    for (const Cell& cell : row) {  // JSON has no NaN
      if (const double* number = std::get_if<double>(&cell))
        cells.push_back(std::isfinite(*number) ? nlohmann::ordered_json(std::stod(text_of(cell))) : nullptr);
      else
        cells.push_back(std::get<std::string>(cell));
    }
    rows += (rows.empty() ? "" : ",\n") + cells.dump();
  }
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
