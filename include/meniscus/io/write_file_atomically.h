// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string_view>

namespace meniscus {

/// Makes `contents` the file at `path`: written to a temporary name in the same directory, synced to
/// the disk, then renamed. Whoever reads `path` sees the old file or the new one, never a part.
/// A link is followed; an older file's permissions are kept; a device or pipe (/dev/stdout) is
/// written to directly. Safe to call from several threads and processes at once.
/// Throws FileError, naming the file and the reason, and then leaves neither the temporary file nor
/// a change to the older one.
void write_file_atomically(const std::filesystem::path& path, std::string_view contents);

/// Adds `contents` to the end of a file that is there, and syncs it to the disk.
/// Throws FileError, naming the file and the reason, and then cuts the file to what it was.
void append_to_file(const std::filesystem::path& path, std::string_view contents);

/// Removes the temporary files that killed programs left in a directory. Call it only while no other
/// program writes there. Throws FileError.
void remove_temporary_files(const std::filesystem::path& directory);

}  // namespace meniscus
