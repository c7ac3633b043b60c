// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "console.h"
#include "meniscus/io/mesh_format.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// What all verbs share: their common options, and how they are put into the command line.
namespace meniscus::tools {

/// Exit codes that are not an exception's.
enum ExitCode { done = 0, defects_found = 1, usage_error = 2, interrupted = 130 };

/// Options that every verb takes.
struct CommonOptions {
  std::string json;  ///< where the report goes: a file or "-"; empty: nowhere
  bool quiet = false;
  bool verbose = false;
  int threads = 0;                   ///< 0: as many as there are
  std::optional<MeshFormat> format;  ///< of "-"

  Console console() const { return {quiet, verbose}; }
  bool has_report() const { return !json.empty(); }
};

/// What runs after the command line was understood; its result is the exit code.
using Run = std::function<int()>;

/// The texts that --help opens with.
struct VerbText {
  std::string name;
  std::string what;         ///< one sentence
  std::string examples[2];  ///< command lines
};

/// For the program's own --help: one line a verb.
std::shared_ptr<CLI::FormatterBase> overview_formatter();

/// Adds a verb with the common options. `examples` come first in its --help.
CLI::App* add_verb(CLI::App& app, const VerbText& text, CommonOptions& common);

/// --format, for verbs that read or write meshes.
void add_format(CLI::App& verb, CommonOptions& common);

/// Adds the option -o,--output.
CLI::Option* add_output(CLI::App& verb, std::string& output, const std::string& what);

/// An option of a number that must be finite and greater than zero, with its unit as in "cm".
CLI::Option* add_positive(CLI::App& verb, const std::string& name, std::optional<double>& value,
                          const std::string& unit, const std::string& what);

/// Whether two names are of one file, or would be if it were there.
bool is_same_file(const std::string& a, const std::string& b);

/// The text of a number's option as a finite double. Throws UsageError, naming the option.
double parse_number(const std::string& option, const std::string& text);

/// The verbs; each adds itself and, if it is the one on the command line, sets `run`.
void add_check(CLI::App& app, Run& run);
void add_convert(CLI::App& app, Run& run);
void add_remesh(CLI::App& app, Run& run);
void add_merge(CLI::App& app, Run& run);
void add_split(CLI::App& app, Run& run);
void add_flow(CLI::App& app, Run& run);
void add_evolve(CLI::App& app, Run& run);
void add_view(CLI::App& app, Run& run);
void add_schema(CLI::App& app, Run& run);
void add_bench(CLI::App& app, Run& run);

}  // namespace meniscus::tools
