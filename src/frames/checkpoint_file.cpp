// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/frames/checkpoint_file.h"

#include "meniscus/core/error.h"
#include "meniscus/io/write_file_atomically.h"

#include <fmt/format.h>
#include <boost/crc.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <system_error>

namespace meniscus {
namespace {

namespace fs = std::filesystem;
using State = nlohmann::json;

constexpr std::size_t deepest_nesting = 16;
constexpr std::size_t num_kept = 2;
constexpr std::string_view mark = "meniscus checkpoint ";
constexpr std::string_view start = "checkpoint_", end = ".bin";

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw FileError(fmt::format("{}: {}; resume from an older checkpoint, or start over", name, what));
}

/// The number that `text` starts with, taken off it with the character behind it, which must be `after`.
template <class T>
std::optional<T> take_number(std::string_view& text, char after, int base) {
  T value = 0;
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  const auto length = static_cast<std::size_t>(last - text.data());
  if (error != std::errc() || length >= text.size() || *last != after) return std::nullopt;
  text.remove_prefix(length + 1);
  return value;
}

/// Stops the parser, which calls itself for what is nested, before the stack ends.
class NestingGuard : public nlohmann::json_sax<State> {
 public:
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(std::int64_t) override { return true; }
  bool number_unsigned(std::uint64_t) override { return true; }
  bool number_float(double, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(State::binary_t&) override { return true; }
  bool start_object(std::size_t) override { return ++depth_ <= deepest_nesting; }
  bool key(std::string&) override { return true; }
  bool end_object() override { return --depth_, true; }
  bool start_array(std::size_t) override { return ++depth_ <= deepest_nesting; }
  bool end_array() override { return --depth_, true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  std::size_t depth_ = 0;
};

std::optional<std::int64_t> step_of(const fs::path& file) {
  const std::string name = file.filename().string();
  std::string_view text = name;
  if (text.substr(0, start.size()) != start) return std::nullopt;
  text.remove_prefix(start.size());
  const auto step = take_number<std::int64_t>(text, '.', 10);
  return step && *step >= 0 && checkpoint_name(*step) == name ? step : std::nullopt;
}

void remove_file(const fs::path& file) {
  std::error_code error;
  fs::remove(file, error);
  if (error) throw FileError(fmt::format("{}: cannot be removed ({})", file.string(), error.message()));
}

}  // namespace

std::uint32_t checksum(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::string checkpoint_name(std::int64_t step) { return fmt::format("{}{:08}{}", start, step, end); }

std::vector<fs::path> find_checkpoints(const fs::path& directory) {
  std::vector<std::pair<std::int64_t, fs::path>> found;
  std::error_code error;
  for (fs::directory_iterator entry(directory, error), last; !error && entry != last; entry.increment(error))
    if (const auto step = step_of(entry->path())) found.emplace_back(*step, entry->path());
  std::sort(found.rbegin(), found.rend());
  std::vector<fs::path> files;
  files.reserve(found.size());
  for (auto& file : found) files.push_back(std::move(file.second));
  return files;
}

std::string encode_checkpoint(const State& state) {
  std::string body;
  State::to_cbor(state, body);
  return fmt::format("{}{} {} {:08x}\n", mark, checkpoint_format, body.size(), checksum(body)) + body;
}

State decode_checkpoint(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, mark.size()) != mark) fail(name, "is no checkpoint");
  bytes.remove_prefix(mark.size());
  const auto version = take_number<int>(bytes, ' ', 10);
  if (version && *version != checkpoint_format)
    fail(name, fmt::format("is in format {}, but this version reads {}", *version, checkpoint_format));
  const auto size = take_number<std::uint64_t>(bytes, ' ', 10);
  const auto crc = take_number<std::uint32_t>(bytes, '\n', 16);
  if (!version || !size || !crc || *size != bytes.size()) fail(name, "is cut off or damaged");
  if (*crc != checksum(bytes)) fail(name, "is damaged: its checksum is another");
  NestingGuard guard;
  if (!State::sax_parse(bytes.begin(), bytes.end(), &guard, State::input_format_t::cbor)) fail(name, "is no CBOR");
  try {
    return State::from_cbor(bytes.begin(), bytes.end());
  } catch (const State::exception& error) {
    fail(name, error.what());
  }
}

void write_checkpoint(const fs::path& directory, std::int64_t step, const State& state) {
  write_file_atomically(directory / checkpoint_name(step), encode_checkpoint(state));
  const std::vector<fs::path> files = find_checkpoints(directory);
  for (std::size_t k = num_kept; k < files.size(); ++k) remove_file(files[k]);
}

void remove_checkpoints(const fs::path& directory) {
  for (const fs::path& file : find_checkpoints(directory)) remove_file(file);
}

}  // namespace meniscus
