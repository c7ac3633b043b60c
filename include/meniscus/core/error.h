// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

/// What can go wrong, by kind. Each kind has its own exit code in the command line tool.
/// Messages name the file or the element, what is wrong with it, and what to do.
namespace meniscus {

/// The root of every exception that the library throws on purpose.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An option or a scene that means nothing (exit code 2).
class UsageError : public Error {
 public:
  using Error::Error;
};

/// A file that cannot be read or written (exit code 3).
class FileError : public Error {
 public:
  using Error::Error;
};

/// A mesh that an operation cannot take (exit code 4), with the faces and vertices at fault.
class GeometryError : public Error {
 public:
  explicit GeometryError(const std::string& message, std::vector<std::size_t> faces = {},
                         std::vector<std::size_t> vertices = {})
      : Error(message), faces_(std::move(faces)), vertices_(std::move(vertices)) {}

  const std::vector<std::size_t>& faces() const { return faces_; }
  const std::vector<std::size_t>& vertices() const { return vertices_; }

 private:
  std::vector<std::size_t> faces_;
  std::vector<std::size_t> vertices_;
};

/// A solver that did not converge or a number that is not finite (exit code 5).
class NumericsError : public Error {
 public:
  using Error::Error;
};

/// A drop that the independent judge found unsound (exit code 5): a fault of this program, or of a time step that
/// is too large for it.
class SoundnessError : public NumericsError {
 public:
  using NumericsError::NumericsError;
};

}  // namespace meniscus
