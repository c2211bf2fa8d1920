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

enum class Format { obj, gltf };

Format format_of(const std::string& name) {
    std::string ending = std::filesystem::path(name).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending == ".obj") return Format::obj;
    if (ending == ".gltf" || ending == ".glb") return Format::gltf;
    throw Error(Errc::cannot_read,
                fmt::format("{}: '{}' is no ending of a mesh's file (expected .obj, .gltf or .glb)",
                            name, ending));
}

template <class Vector>
bool finite(const Vector& v) {
    for (unsigned i = 0; i < Vector::dimensions(); ++i)
        if (!std::isfinite(v[static_cast<int>(i)])) return false;
    return true;
}

void check_finite(const detail::InputFile& file, const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const char* what = nullptr;
        if (!finite(mesh.positions[i])) what = "position";
        if (!finite(mesh.normals[i])) what = "normal";
        if (!mesh.texture_coordinates.empty() && !finite(mesh.texture_coordinates[i]))
            what = "texture coordinate";
        if (!mesh.tangents.empty() && !finite(mesh.tangents[i])) what = "tangent";
        if (what != nullptr)
            file.fail(fmt::format("the {} of vertex {} is not a finite number", what, i));
    }
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path, const MeshReadOptions& options) {
    (void)format_of(path.string());  // before a file of another kind is opened
    detail::InputFile file(path);
    return detail::read_mesh(file, options.memory_limit);
}

namespace detail {

Mesh read_mesh(InputFile& file, std::uint64_t memory_limit) {
    Mesh mesh = format_of(file.name()) == Format::obj ? read_obj(file, memory_limit)
                                                      : read_gltf(file, memory_limit);
    check_finite(file, mesh);
    tidy(mesh);
    if (mesh.indices.empty()) file.fail("it has no triangle that has an area");
    complete_normals(mesh);
    complete_tangents(mesh);
    return mesh;
}

void check_memory(const InputFile& file, double needed, std::uint64_t limit) {
    if (needed > static_cast<double>(limit))
        file.fail(fmt::format("the mesh needs about {:.0f} MiB of memory (the limit is {:.0f})",
                              needed / (1 << 20), static_cast<double>(limit) / (1 << 20)));
}

}  // namespace detail
}  // namespace mirrorball
