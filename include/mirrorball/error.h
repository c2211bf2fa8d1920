// The one exception that crosses the API.
#pragma once

#include <stdexcept>
#include <string>

namespace mirrorball {

/// What went wrong, as far as a caller can act on it. The program's exit codes follow from it.
enum class Errc {
    usage,         ///< a request that cannot be met as it was put: a bad option, size or name
    cannot_read,   ///< missing, truncated, malformed or too large a file; a texel that is no number
    cannot_write,  ///< no permission, no space, a format that cannot hold what it was given
    unsupported,   ///< valid, but not in this build
    cancelled,     ///< the caller's progress callback asked to stop
};

/// The message names the file or option, what was found and what was expected:
/// `sky.hdr: 4096 x 2000 is not an equirect map (its width must be twice its height)`.
class Error : public std::runtime_error {
  public:
    Error(Errc code, const std::string& message) : std::runtime_error(message), code_(code) {}
    [[nodiscard]] Errc code() const noexcept { return code_; }

  private:
    Errc code_;
};

}  // namespace mirrorball
