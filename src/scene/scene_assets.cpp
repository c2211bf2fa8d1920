// What a scene names, loaded: each name once, and every error says who wanted it.
#include <mirrorball/scene_assets.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <mirrorball/builtin.h>
#include <mirrorball/error.h>

#include "scene/bump_texels.h"

namespace mirrorball {
namespace {

constexpr std::string_view kBuiltin = "builtin:";

// What is left of the memory that all assets may hold.
class Budget {
  public:
    explicit Budget(std::uint64_t bytes) : left_(bytes) {}

    [[nodiscard]] std::uint64_t left() const { return left_; }
    void check(std::uint64_t bytes, std::string_view name) const {
        if (bytes > left_) {
            throw Error(Errc::cannot_read,
                        fmt::format("{}: needs {} bytes; of the memory limit {} are left", name,
                                    bytes, left_));
        }
    }
    void spend(std::uint64_t bytes, std::string_view name) {
        check(bytes, name);
        if (left_ != kUnlimitedMemory) left_ -= bytes;
    }

  private:
    std::uint64_t left_;
};

template <class T>
std::uint64_t bytes_of(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

std::uint64_t bytes_of(const Mesh& mesh) {
    return bytes_of(mesh.positions) + bytes_of(mesh.normals) + bytes_of(mesh.texture_coordinates) +
           bytes_of(mesh.tangents) + bytes_of(mesh.indices);
}

std::uint64_t bytes_of(const Image& image) {
    return image.values().size_bytes();
}

std::uint64_t bytes_of(const BumpTexels& texels) {
    return bytes_of(texels.slopes.slopes) + bytes_of(texels.heights);
}

std::uint64_t bytes_of(const EnvironmentMap& map) {
    std::uint64_t sum = 0;
    for (const Level& level : map.levels)
        for (const Image& face : level.faces) sum += bytes_of(face);
    return sum;
}

// A name without an ending is meant to be a built-in mesh, and if it is none, that is the error.
bool is_builtin(const std::string& name) {
    const std::vector<BuiltinMesh> meshes = builtin_meshes();
    return std::any_of(meshes.begin(), meshes.end(),
                       [&](const BuiltinMesh& mesh) { return mesh.name == name; }) ||
           !std::filesystem::path(name).has_extension();
}

Mesh load_mesh(const std::string& name, const std::filesystem::path& folder,
               const AssetOptions& options, std::uint64_t memory) {
    if (is_builtin(name)) return make_mesh(name, options.mesh_detail);
    Mesh mesh = read_mesh(folder / name, {.memory_limit = memory});
    if (mesh.indices.empty()) {
        throw Error(Errc::cannot_read,
                    fmt::format("{}: has no triangle", (folder / name).string()));
    }
    return mesh;
}

Image with_three_channels(const Image& image) {
    Image result(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const bool grey = image.channels() < 3;
            result.set_rgb(x, y, grey ? Vec3f(*image.at(x, y)) : image.rgb(x, y));
        }
    return result;
}

Image load_picture(const std::string& name, const std::filesystem::path& folder,
                   std::uint64_t memory) {
    ReadOptions options;
    options.memory_limit = memory;
    Image image = read_image(folder / name, options);
    const auto is_number = [](float value) { return std::isfinite(value); };
    if (!std::all_of(image.values().begin(), image.values().end(), is_number)) {
        throw Error(Errc::cannot_read,
                    fmt::format("{}: has a texel that is no number", (folder / name).string()));
    }
    return image.channels() == 3 ? image : with_three_channels(image);
}

// Slopes, heights and what they are made of.
std::uint64_t bytes_to_make(const BumpMap& bump) {
    constexpr std::uint64_t kBytesPerTexel = 32;
    return kBytesPerTexel * static_cast<std::uint64_t>(bump.size) *
           static_cast<std::uint64_t>(bump.size);
}

void load_bump(const BumpMap& bump, const std::filesystem::path& folder, SceneAssets& assets,
               Budget& budget) {
    if (bump.is_smooth() || assets.bumps.count(bump_key(bump)) != 0) return;
    const bool is_source = detail::is_bump_source(bump);
    if (is_source) budget.check(bytes_to_make(bump), bump.source);
    if (moves(bump)) return;
    BumpTexels texels = is_source ? detail::make_bump_texels(bump, 0)
                                  : detail::read_bump_texels(bump, folder, budget.left());
    budget.spend(bytes_of(texels), bump.source);
    assets.bumps[bump_key(bump)] = std::make_shared<const BumpTexels>(std::move(texels));
}

// Bumps need to know which way a surface's texture runs.
void add_tangents(Mesh& mesh, const std::string& name) {
    if (!mesh.tangents.empty()) return;
    if (mesh.texture_coordinates.empty()) {
        throw Error(Errc::cannot_read,
                    fmt::format("a bump map needs texture coordinates, and {} has none", name));
    }
    mesh = with_tangents(mesh);
}

// A list of files, or a pattern, or one: each of them relative to the folder.
std::string environment_source(const std::string& source, const std::filesystem::path& folder) {
    if (source.starts_with(kBuiltin)) return source;
    std::string result;
    for (std::size_t start = 0; start <= source.size();) {
        const std::size_t end = std::min(source.find(',', start), source.size());
        if (start > 0) result += ',';
        result += (folder / source.substr(start, end - start)).string();
        start = end + 1;
    }
    return result;
}

// Errors get the name of who wanted it in front.
template <class Load>
auto loaded_for(const std::string& who, Load&& load) {
    try {
        return load();
    } catch (const Error& error) {
        throw Error(error.code(), fmt::format("{}: {}", who, error.what()));
    }
}

std::string title(const Scene& scene, std::size_t i) {
    const std::string& name = scene.objects[i].name;
    return name.empty() ? fmt::format("objects[{}]", i)
                        : fmt::format("objects[{}] \"{}\"", i, name);
}

// What the scene names and the assets have not got, within the budget.
void load_within(Budget& budget, SceneAssets& assets, const Scene& scene,
                 const std::filesystem::path& folder, const AssetOptions& options) {
    const auto add_picture = [&](const std::string& name) {
        if (name.empty() || assets.pictures.count(name) != 0) return;
        Image picture = load_picture(name, folder, budget.left());
        budget.spend(bytes_of(picture), name);
        assets.pictures[name] = std::move(picture);
    };
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        loaded_for(title(scene, i), [&] {
            if (assets.meshes.count(object.mesh) == 0) {
                Mesh mesh = load_mesh(object.mesh, folder, options, budget.left());
                budget.spend(bytes_of(mesh), object.mesh);
                assets.meshes[object.mesh] = std::move(mesh);
            }
            const Material& material = object.material;
            add_picture(material.base_color_map);
            if (material.floor) add_picture(material.floor->color_map);
            load_bump(material.bump, folder, assets, budget);
            if (!material.bump.is_smooth()) add_tangents(assets.meshes[object.mesh], object.mesh);
        });
    }
}

}  // namespace

bool is_loaded(const Scene& scene, const SceneAssets& assets) {
    const auto has_picture = [&](const std::string& name) {
        return name.empty() || assets.pictures.count(name) != 0;
    };
    const auto has_bump = [&](const SceneObject& object) {
        const BumpMap& bump = object.material.bump;
        return bump.is_smooth() || ((moves(bump) || assets.bumps.count(bump_key(bump)) != 0) &&
                                    !assets.meshes.at(object.mesh).tangents.empty());
    };
    return std::all_of(scene.objects.begin(), scene.objects.end(), [&](const SceneObject& object) {
        const Material& material = object.material;
        return assets.meshes.count(object.mesh) != 0 && has_picture(material.base_color_map) &&
               (!material.floor || has_picture(material.floor->color_map)) && has_bump(object);
    });
}

void load_missing(SceneAssets& assets, const Scene& scene, const std::filesystem::path& folder,
                  const AssetOptions& options) {
    Budget budget(options.memory_limit);
    load_within(budget, assets, scene, folder, options);
}

LoadedMap load_environment(const SceneEnvironment& environment, const std::filesystem::path& folder,
                           const AssetOptions& options) {
    if (options.builtin_width > 0 && environment.source.starts_with(kBuiltin)) {
        LoadedMap drawn;
        drawn.map = make_builtin(environment.source.substr(kBuiltin.size()), Projection::equirect,
                                 options.builtin_width, default_axes(Projection::equirect));
        drawn.format = "built-in";
        return drawn;
    }
    MapReadOptions read_options;
    read_options.memory_limit = options.memory_limit;
    read_options.progress = options.reading;
    return read_map(environment_source(environment.source, folder), read_options);
}

Axes turned(const Axes& axes, const SceneEnvironment& environment) {
    return rotated(axes, environment.yaw, environment.pitch, environment.roll);
}

SceneAssets load_assets(const Scene& scene, const std::filesystem::path& folder,
                        const AssetOptions& options) {
    SceneAssets assets;
    Budget budget(options.memory_limit);
    load_within(budget, assets, scene, folder, options);
    loaded_for("environment", [&] {
        AssetOptions left = options;
        left.memory_limit = budget.left();
        assets.environment = load_environment(scene.environment, folder, left).map;
        budget.spend(bytes_of(assets.environment), scene.environment.source);
    });
    return assets;
}

}  // namespace mirrorball
