// What the program says: results on stdout, everything else on stderr.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include <mirrorball/environment_map.h>
#include <mirrorball/io.h>

namespace mirrorball::cli {

inline constexpr int kUsageExitCode = 2;

struct Shared;
using Json = nlohmann::ordered_json;  // keys stay in the order in which they were written

/// A verb's result. \throws Error(Errc::cannot_write) if stdout does not take it
void print(const std::string& text);
void print_json(const Json& json);

/// A file of text, whole or not at all. \throws Error(Errc::cannot_write)
void write_text(const std::filesystem::path& path, const std::string& text);

/// What the program says of an error, and the exit code that stands for it.
struct Failure {
    int exit_code;
    std::string message;
    bool interrupted = false;
};
/// Of the exception that is being handled.
[[nodiscard]] Failure current_failure();
/// `mirrorball: MESSAGE` on stderr.
void tell_failure(const Failure& failure);

/// `mirrorball: note: ...` on stderr, unless --quiet.
void tell(const Shared& shared, const std::string& note);

/// Numbers with few digits: "1.23e+04", "0.5".
[[nodiscard]] std::string figure(double value);
[[nodiscard]] std::string figures(const Vec3d& value);
[[nodiscard]] Json to_json(const Vec3d& value);
[[nodiscard]] Json to_json(const Vec3f& value);

/// "cube, 6 x 256 x 256"
[[nodiscard]] std::string shape_text(const EnvironmentMap& map);
[[nodiscard]] std::string shape_text(Projection projection, int width, int height, int level_count);

/// Prints what was written and tells what it had to clip.
void print_written(const std::string& target, const EnvironmentMap& map, const WriteReport& report,
                   const Shared& shared);
/// One line of it.
[[nodiscard]] std::string written_text(const std::string& target, const EnvironmentMap& map,
                                       const WriteReport& report);
[[nodiscard]] Json to_json(const std::string& target, const EnvironmentMap& map,
                           const WriteReport& report);
void tell_clipped(const std::string& target, const WriteReport& report, const Shared& shared);

}  // namespace mirrorball::cli
