// SPDX-License-Identifier: GPL-3.0-or-later
#include "report.h"

#include "meniscus/core/error.h"
#include "meniscus/io/write_file_atomically.h"
#include "mesh_files.h"

#include <iostream>

namespace meniscus::tools {
namespace {

constexpr double degrees = 180 / 3.14159265358979323846;

Json to_json(const Defect& defect) {
  return {
      {"kind", name(defect.kind)}, {"message", defect.message}, {"faces", defect.faces}, {"vertices", defect.vertices}};
}

}  // namespace

Json to_json(const std::string& file, const Inspection& i) {
  Json defects = Json::array();
  for (const Defect& defect : i.defects) defects.push_back(to_json(defect));
  return {{"file", shown_name(file)},
          {"vertices", i.vertices},
          {"faces", i.faces},
          {"components", i.components},
          {"genus", i.genus ? Json(*i.genus) : Json(nullptr)},
          {"closed", i.closed},
          {"manifold", i.manifold},
          {"outward", i.outward},
          {"self_intersecting", i.self_intersecting},
          {"bounds_volume", i.bounds_volume},
          {"sound", i.sound},
          {"volume", i.volume},
          {"area", i.area},
          {"edge_length", {{"min", i.edge_length.min}, {"mean", i.edge_length.mean}, {"max", i.edge_length.max}}},
          {"angle_deg", {{"min", i.angle.least * degrees}, {"max", i.angle.greatest * degrees}}},
          {"defects", std::move(defects)}};
}

void write_stdout(const std::string& text) {
  std::cout.write(text.data(), static_cast<std::streamsize>(text.size())).flush();
  if (!std::cout)
    throw FileError("<stdout>: cannot be written; check the space left and that the reader is still there");
}

void write_report(const Json& report, const CommonOptions& common) {
  if (!common.has_report()) return;
  const std::string text = report.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
  common.json == "-" ? write_stdout(text) : write_file_atomically(common.json, text);
}

void Report::add_input(const std::string& file, const MeshData& data) {
  if (!common_.has_report()) return;
  const Inspection inspection = inspect(data);
  inputs_.push_back(tools::to_json(file, inspection));
  if (first_defect_.empty() && !inspection.defects.empty()) first_defect_ = name(inspection.defects.front().kind);
}

void Report::add_output(const std::string& file, const MeshData& data) {
  const Inspection inspection = inspect(data);
  const std::string shown = file == "-" ? "<stdout>" : file;
  if (!inspection.defects.empty())
    common_.console().say(fmt::format("warning: {}: not sound: {}", shown, inspection.defects.front().message));
  outputs_.push_back(tools::to_json(shown, inspection));
}

Json Report::body(const char* status) const {
  Json report{{"status", status}};
  report["inputs"] = inputs_;
  report["outputs"] = outputs_;
  report["seconds"] = seconds_;
  report.update(counts_);
  return report;
}

Json Report::to_json() const { return body("ok"); }

Json Report::to_json_refused(const GeometryError& error) const {
  Json report{{"status", "refused"},
              {"reason", first_defect_.empty() ? reason_ : first_defect_},
              {"message", error.what()},
              {"faces", error.faces()},
              {"vertices", error.vertices()}};
  report.update(body("refused"));
  report["outputs"] = Json::array();  // nothing was written
  return report;
}

int run_reported(const CommonOptions& common, const std::function<void(Report&)>& work) {
  Report report(common);
  try {
    work(report);
  } catch (const GeometryError& error) {
    write_report(report.to_json_refused(error), common);
    throw;
  }
  write_report(report.to_json(), common);
  return done;
}

}  // namespace meniscus::tools
