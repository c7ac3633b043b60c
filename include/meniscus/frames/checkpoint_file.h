// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Checkpoints as files: a line "meniscus checkpoint <format> <bytes> <crc-32>", then the state as CBOR (RFC 8949).
namespace meniscus {

/// Counts up when a checkpoint holds something else than before; others are refused.
inline constexpr int checkpoint_format = 5;

/// The CRC-32 of ISO 3309.
std::uint32_t checksum(std::string_view bytes);

/// "checkpoint_00000120.bin", after step 120.
std::string checkpoint_name(std::int64_t step);

/// The checkpoints in a directory, the newest first; none if there is no directory.
std::vector<std::filesystem::path> find_checkpoints(const std::filesystem::path& directory);

/// The file's bytes for a state, and back. `name` stands for the file in messages.
/// Decoding throws FileError if a byte is not as it was written, if the format is another version's, or if it
/// nests deeper than a checkpoint does; it takes memory in proportion to `bytes`.
std::string encode_checkpoint(const nlohmann::json& state);
nlohmann::json decode_checkpoint(std::string_view bytes, const std::string& name);

/// Writes the file of a step, whole or not at all, then removes all but the newest two. Throws FileError.
void write_checkpoint(const std::filesystem::path& directory, std::int64_t step, const nlohmann::json& state);

/// Removes all of them. Throws FileError.
void remove_checkpoints(const std::filesystem::path& directory);

}  // namespace meniscus
