// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz.h"
#include "meniscus/core/error.h"
#include "meniscus/frames/checkpoint_archive.h"
#include "meniscus/frames/checkpoint_file.h"
#include "meniscus/state/judge.h"

#include <fmt/format.h>
#include <boost/crc.hpp>

/// The checkpoint reader, behind its checksum: the input is the body, and gets the header that belongs to it.
void meniscus::fuzz::run(std::string_view input) {
  boost::crc_32_type crc;
  crc.process_bytes(input.data(), input.size());
  const std::string file =
      fmt::format("meniscus checkpoint {} {} {:08x}\n{}", checkpoint_format, input.size(), crc.checksum(), input);
  std::vector<Drop> drops;
  try {
    const nlohmann::json state = decode_checkpoint(file, "fuzz");
    CheckpointReader reader(state, "fuzz");
    reader("drops", drops);
  } catch (const FileError&) {
    return;
  }
  for (const Drop& drop : drops) {
    require(judge::connectivity_defect(drop).empty());
    require(drop.mesh().is_valid(false));
  }
  CheckpointWriter writer;  // what was read can be written, and says the same again
  writer("drops", drops);
  std::vector<Drop> again;
  CheckpointReader reader(writer.state(), "again");
  reader("drops", again);
  CheckpointWriter second;
  second("drops", again);
  require(second.state() == writer.state());
}
