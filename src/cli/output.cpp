#include "output.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <new>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>

#include "interrupt.h"
#include "io/file.h"
#include "options.h"

namespace mirrorball::cli {
namespace {

int exit_code(Errc code) {
    switch (code) {
        case Errc::usage:
            return kUsageExitCode;
        case Errc::cannot_read:
            return 3;
        case Errc::cannot_write:
            return 4;
        case Errc::unsupported:
            return 5;
        case Errc::cancelled:
            return kInterruptedExitCode;
    }
    return kUsageExitCode;
}

}  // namespace

Failure current_failure() {
    try {
        throw;
    } catch (const Error& error) {
        if (error.code() == Errc::cancelled) return {kInterruptedExitCode, "interrupted", true};
        return {exit_code(error.code()), error.what()};
    } catch (const std::bad_alloc&) {
        return {kUsageExitCode, "not enough memory; a smaller --size needs less"};
    } catch (const std::exception& error) {
        return {kUsageExitCode, error.what()};
    }
}

void tell_failure(const Failure& failure) {
    fmt::print(stderr, "mirrorball: {}\n", failure.message);
}

void print(const std::string& text) {
    errno = 0;
    const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
    if (!written || std::fflush(stdout) != 0) {
        throw Error(Errc::cannot_write, fmt::format("standard output: {}", std::strerror(errno)));
    }
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    detail::OutputFile file(path);
    file.write(text);
    file.commit();
}

// Names of files need not be UTF-8; what is not is shown by a replacement character.
void print_json(const Json& json) {
    print(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void tell(const Shared& shared, const std::string& note) {
    if (!shared.quiet) fmt::print(stderr, "mirrorball: note: {}\n", note);
}

std::string figure(double value) {
    return fmt::format("{:.4g}", value);
}

std::string figures(const Vec3d& value) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", value.x, value.y, value.z);
}

Json to_json(const Vec3d& value) {
    return {value.x, value.y, value.z};
}
Json to_json(const Vec3f& value) {
    return {value.x, value.y, value.z};
}

std::string shape_text(Projection projection, int width, int height, int level_count) {
    const int faces = face_count(projection);
    const std::string count = faces > 1 ? fmt::format("{} x ", faces) : "";
    std::string text = fmt::format("{}, {}{} x {}", name(projection), count, width, height);
    if (level_count > 1) text += fmt::format(", {} levels", level_count);
    return text;
}

std::string shape_text(const EnvironmentMap& map) {
    return shape_text(map.projection, map.width(), map.height(), map.level_count());
}

Json to_json(const std::string& target, const EnvironmentMap& map, const WriteReport& report) {
    return {{"file", target},
            {"bytes", report.byte_count},
            {"projection", name(map.projection)},
            {"width", map.width()},
            {"height", map.height()},
            {"levels", map.level_count()},
            {"axes", to_string(map.axes)},
            {"clipped_texels", report.clipped_texel_count},
            {"lost_flux", to_json(report.lost_flux)}};
}

void tell_clipped(const std::string& target, const WriteReport& report, const Shared& shared) {
    if (report.clipped_texel_count == 0) return;
    tell(shared, fmt::format("{}: {} texels were beyond what the format holds and are clipped; "
                             "flux lost: {}",
                             target, report.clipped_texel_count, figures(report.lost_flux)));
}

void print_written(const std::string& target, const EnvironmentMap& map, const WriteReport& report,
                   const Shared& shared) {
    tell_clipped(target, report, shared);
    if (shared.json) return print_json(to_json(target, map, report));
    if (shared.quiet) return;
    print(written_text(target, map, report));
}

std::string written_text(const std::string& target, const EnvironmentMap& map,
                         const WriteReport& report) {
    return fmt::format("{}: {}, {}\n", target, shape_text(map), bytes_text(report.byte_count));
}

}  // namespace mirrorball::cli
