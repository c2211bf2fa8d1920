#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>
#include <mirrorball/error.h>
#include <mirrorball/mesh.h>

#include "readers.h"
#include "tidy.h"

namespace mirrorball {
namespace {

std::string ending_of(const std::filesystem::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

Mesh decode(const std::filesystem::path& path, std::uint64_t memory_limit) {
    const std::string ending = ending_of(path);
    const bool obj = ending == ".obj", gltf = ending == ".gltf" || ending == ".glb";
    if (!obj && !gltf)
        throw Error(Errc::cannot_read,
                    fmt::format("{}: '{}' is no ending of a mesh's file (expected .obj, .gltf or "
                                ".glb)",
                                path.string(), ending));
    detail::InputFile file(path);
    Mesh mesh = obj ? detail::read_obj(file, memory_limit) : detail::read_gltf(file, memory_limit);
    detail::check_finite(file, mesh);
    detail::tidy(mesh);
    if (mesh.indices.empty()) file.fail("it has no triangle that has an area");
    return mesh;
}

bool finite(const Vec3f& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path, const MeshReadOptions& options) {
    Mesh mesh = decode(path, options.memory_limit);
    detail::complete_normals(mesh);
    return mesh;
}

namespace detail {

void check_finite(const InputFile& file, const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const char* what = nullptr;
        if (!finite(mesh.positions[i])) what = "position";
        if (!finite(mesh.normals[i])) what = "normal";
        if (!mesh.texture_coordinates.empty() && !(std::isfinite(mesh.texture_coordinates[i].x) &&
                                                   std::isfinite(mesh.texture_coordinates[i].y)))
            what = "texture coordinate";
        if (what != nullptr)
            file.fail(fmt::format("the {} of vertex {} is not a finite number", what, i));
    }
}

void check_memory(const InputFile& file, double needed, std::uint64_t limit) {
    if (needed > static_cast<double>(limit))
        file.fail(fmt::format("the mesh needs about {:.0f} MiB of memory (the limit is {:.0f})",
                              needed / (1 << 20), static_cast<double>(limit) / (1 << 20)));
}

}  // namespace detail
}  // namespace mirrorball
