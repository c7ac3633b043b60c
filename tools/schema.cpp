// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"
#include "meniscus/core/error.h"
#include "meniscus/scene/scene_schema.h"
#include "report.h"

namespace meniscus::tools {
namespace {

struct SchemaOptions {
  CommonOptions common;
  bool markdown = false;
};

int schema(const SchemaOptions& options) {
  if (options.common.has_report() && options.markdown)
    throw UsageError("--markdown goes to stdout; --json is the schema itself");
  if (options.common.has_report())
    write_report(Json::parse(scene_schema()), options.common);
  else
    write_stdout((options.markdown ? scene_reference_markdown() : scene_schema()) + '\n');
  return done;
}

}  // namespace

void add_schema(CLI::App& app, Run& run) {
  const auto options = std::make_shared<SchemaOptions>();
  CLI::App* verb = add_verb(app,
                            {"schema",
                             "Print the JSON Schema of scene files, made from the table that reads them.",
                             {"meniscus schema > scene.schema.json", "meniscus schema --markdown"}},
                            options->common);
  verb->add_flag("--markdown", options->markdown, "The same keys as a reference for people, in Markdown");
  verb->callback([=, &run] { run = [=] { return schema(*options); }; });
}

}  // namespace meniscus::tools
