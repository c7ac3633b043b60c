// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"

#include "meniscus/core/error.h"

#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace meniscus::tools {
namespace {

/// --help that opens with examples.
class ExamplesFirst : public CLI::Formatter {
 public:
  explicit ExamplesFirst(const VerbText& text) : text_(text) { column_width(34); }
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    std::string examples = "Examples:\n";
    for (const std::string& example : text_.examples)
      if (!example.empty()) examples += "  " + example + '\n';
    return examples + '\n' + CLI::Formatter::make_help(app, std::move(name), mode);
  }
  std::string make_description(const CLI::App* app) const override {
    return CLI::Formatter::make_description(app) + '\n';
  }

 private:
  VerbText text_;
};

/// --help of the program itself: of each verb only its first sentence.
class FirstSentences : public CLI::Formatter {
 public:
  FirstSentences() { column_width(12); }
  std::string make_subcommand(const CLI::App* verb) const override {
    const std::string what = verb->get_description();
    return fmt::format("  {:10}{}\n", verb->get_name(), what.substr(0, what.find(". ")));
  }
};

}  // namespace

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error)) return true;
  const auto whole = [](const std::string& name) {
    return (std::filesystem::current_path() / name).lexically_normal();
  };
  return whole(a) == whole(b);
}

std::shared_ptr<CLI::FormatterBase> overview_formatter() { return std::make_shared<FirstSentences>(); }

CLI::App* add_verb(CLI::App& app, const VerbText& text, CommonOptions& common) {
  CLI::App* verb = app.add_subcommand(text.name, text.what);
  verb->formatter(std::make_shared<ExamplesFirst>(text));
  verb->allow_extras();  // so that main can name the flag that was meant
  verb->add_option("--json", common.json, "Write a report as JSON to FILE, or to stdout with -")->type_name("FILE");
  verb->add_option("--threads", common.threads, "At most N threads (default: as many as there are)")
      ->type_name("N")
      ->check(CLI::Range(1, 4096));
  verb->add_flag("-q,--quiet", common.quiet, "Say nothing but errors");
  verb->add_flag("-v,--verbose", common.verbose, "Say more");
  return verb;
}

void add_format(CLI::App& verb, CommonOptions& common) {
  verb.add_option_function<std::string>(
          "--format", [&common](const std::string& name) { common.format = parse_format(name); },
          "Format of stdin and stdout (-): ply, off, obj or stl")
      ->type_name("FORMAT");
}

CLI::Option* add_output(CLI::App& verb, std::string& output, const std::string& what) {
  return verb.add_option("-o,--output", output, what)->required();
}

double parse_number(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    throw UsageError(fmt::format("{}: \"{}\" is not a finite number", option, text));
  return value;
}

CLI::Option* add_positive(CLI::App& verb, const std::string& name, std::optional<double>& value,
                          const std::string& unit, const std::string& what) {
  return verb
      .add_option_function<std::string>(
          name,
          [name, unit, &value](const std::string& text) {
            value = parse_number(name, text);
            if (!(*value > 0)) throw UsageError(fmt::format("{}: {} is not greater than zero ({})", name, text, unit));
          },
          what)
      ->type_name(unit);
}

}  // namespace meniscus::tools
