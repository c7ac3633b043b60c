// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command.h"
#include "meniscus/core/error.h"
#include "meniscus/core/mesh_data.h"
#include "meniscus/geometry/inspect.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

/// The reports of --json.
namespace meniscus::tools {

using Json = nlohmann::ordered_json;

/// What `check` says of one file.
Json to_json(const std::string& file, const Inspection& inspection);

/// Writes a report where --json asked for it, if it did. Throws FileError.
void write_report(const Json& report, const CommonOptions& common);

/// Text that ends in a line end, on stdout. Throws FileError if it cannot be written.
void write_stdout(const std::string& text);

/// The report of a verb that turns meshes into meshes, filled in as the work goes on.
class Report {
 public:
  explicit Report(const CommonOptions& common) : common_(common) {}

  /// A mesh that was read; inspected only if there will be a report.
  void add_input(const std::string& file, const MeshData& data);
  /// A mesh that will be written. Warns on stderr if it is not sound.
  void add_output(const std::string& file, const MeshData& data);
  /// One of the verb's own counts.
  void add(const std::string& name, Json value) { counts_[name] = std::move(value); }
  /// Why it will be refused, if the inputs are sound.
  void set_reason(const char* reason) { reason_ = reason; }
  /// Runs the verb's own work, on the clock.
  template <class Work>
  auto timed(Work work) {
    const Stopwatch watch(seconds_);
    return work();
  }

  Json to_json() const;
  Json to_json_refused(const GeometryError& error) const;

 private:
  class Stopwatch {
   public:
    explicit Stopwatch(double& sum) : sum_(sum), start_(seconds_now()) {}
    ~Stopwatch() { sum_ += seconds_now() - start_; }

   private:
    double& sum_;
    double start_;
  };

  Json body(const char* status) const;

  const CommonOptions& common_;
  Json inputs_ = Json::array(), outputs_ = Json::array(), counts_ = Json::object();
  double seconds_ = 0;
  std::string first_defect_, reason_ = "operation_refused";
};

/// Runs a verb's work and writes its report: of what it did, or, if it throws GeometryError, of why
/// it was refused (then the exception goes on).
int run_reported(const CommonOptions& common, const std::function<void(Report&)>& work);

}  // namespace meniscus::tools
