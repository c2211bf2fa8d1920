// The report's pictures, all with one exposure, so that they can be compared with each other.
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include <mirrorball/lookup.h>
#include <mirrorball/tone_map.h>

#include "bake.h"
#include "bake_materials.h"
#include "ball.h"
#include "brdf_plots.h"
#include "core/parallel.h"

namespace mirrorball::cli {
namespace {

constexpr int kBallSize = 320, kMaterialSize = 200;
constexpr int kTableSize = 384;
constexpr int kCrossFace = 192, kLevelCrossFace = 96;

class Painter {
  public:
    Painter(const Bake& bake, const std::filesystem::path& folder) : bake_(bake), folder_(folder) {}

    // The environment laid out by a projection; from the source itself, not from the cube.
    void projection(Projection projection, int size, const std::string& file) const {
        write(resample(bake_.source.map, projection, size, default_axes(projection)), file,
              bake_.exposure);
    }

    void cross(const EnvironmentMap& map, int level, int face_size, double exposure,
               const std::string& file) const {
        const EnvironmentMap one{map.projection, map.axes, {map.levels[level]}};
        write(resample(one, Projection::cube, face_size, map.axes), file, exposure);
    }

    void mirror_ball(const EnvironmentMap& map, int level, const std::string& file) const {
        ball(file, [&](const Vec3d& n) { return look_up(map, reflected_view(n), level); });
    }

    // A white matte ball: radiance is irradiance / pi.
    void matte_ball(const EnvironmentMap& map, const std::string& file) const {
        ball(file, [&](const Vec3d& n) { return look_up(map, n) * static_cast<float>(1 / kPi); });
    }

    void harmonics_ball(const NineHarmonics& irradiance, const std::string& file) const {
        ball(file, [&](const Vec3d& n) { return Vec3f(evaluate(irradiance, n) / kPi); });
    }

    void material(const Material& material) const {
        ball(material.file, material.radiance, kMaterialSize);
    }

    // As it is looked up, roughness growing downwards. Sheen's albedo can exceed 1.
    void dfg(const DfgTable& table, const std::string& file) const {
        Image image(kTableSize, kTableSize, 3);
        for (int y = 0; y < kTableSize; ++y) {
            for (int x = 0; x < kTableSize; ++x) {
                const double n_dot_v = (x + 0.5) / kTableSize, roughness = (y + 0.5) / kTableSize;
                const Dfg dfg = table.ggx(n_dot_v, roughness);
                const double sheen = std::min(1.0, table.charlie(n_dot_v, roughness));
                image.set_rgb(x, y, Vec3f(Vec3d(dfg.scale, dfg.bias, sheen)));
            }
        }
        write_image(folder_ / file, image, {.format = TexelFormat::unorm8});
    }

    void fresnel(const Fresnel& fresnel, const std::string& file) const {
        write_text(folder_ / file, fresnel_plot(fresnel, to_string(fresnel)));
    }

  private:
    void ball(const std::string& file, const Shade& radiance, int size = kBallSize) const {
        const auto shade = [&](const Vec3d& n) {
            const Vec3f light = radiance(n);
            return Vec3f(tone_mapped(light.x, bake_.exposure), tone_mapped(light.y, bake_.exposure),
                         tone_mapped(light.z, bake_.exposure));
        };
        write_image(folder_ / file, draw_ball(size, shade), {.format = TexelFormat::unorm8});
    }

    void write(const EnvironmentMap& map, const std::string& file, double exposure) const {
        MapWriteOptions options;
        options.format = TexelFormat::unorm8;
        if (map.projection == Projection::cube) options.layout = Layout::horizontal_cross;
        write_map((folder_ / file).string(), tone_mapped(map, exposure), options);
    }

    const Bake& bake_;
    const std::filesystem::path& folder_;
};

using Task = std::function<void()>;

void add_projections(std::vector<Task>& tasks, const Painter& painter, const Bake& bake) {
    const struct {
        Projection projection;
        int size;
        const char* file;
    } pictures[] = {{Projection::equirect, 1280, "equirect.png"},
                    {Projection::sphere, 512, "sphere.png"},
                    {Projection::dual_paraboloid, 384, "paraboloid-%s.png"},
                    {Projection::angular, 512, "angular.png"},
                    {Projection::octahedral, 512, "octahedral.png"},
                    {Projection::equal_area_octahedral, 512, "equal-area-octahedral.png"}};
    for (const auto& picture : pictures) {
        tasks.emplace_back([&painter, picture] {
            painter.projection(picture.projection, picture.size, picture.file);
        });
    }
    tasks.emplace_back(
        [&] { painter.cross(bake.environment.map, 0, kCrossFace, bake.exposure, "cube.png"); });
}

void add_chain(std::vector<Task>& tasks, const Painter& painter, const Bake& bake,
               const EnvironmentMap& map, const std::string& name) {
    for (int level = 0; level < map.level_count(); ++level) {
        tasks.emplace_back([&, level, name] {
            painter.mirror_ball(map, level, fmt::format("{}-{}-ball.png", name, level));
            painter.cross(map, level, kLevelCrossFace, bake.exposure,
                          fmt::format("{}-{}.png", name, level));
        });
    }
}

}  // namespace

void write_pictures(const Bake& bake, const std::filesystem::path& folder,
                    const Progress& progress) {
    const std::filesystem::path pictures = folder / kPictureFolder;
    std::filesystem::create_directory(pictures);
    const Painter painter(bake, pictures);
    std::vector<Task> tasks;
    add_projections(tasks, painter, bake);
    add_chain(tasks, painter, bake, bake.specular.map, "specular");
    add_chain(tasks, painter, bake, bake.phong.map, "phong");
    tasks.emplace_back([&] {
        painter.matte_ball(bake.diffuse.map, "diffuse-ball.png");
        painter.cross(bake.diffuse.map, 0, kLevelCrossFace, bake.exposure / kPi, "diffuse.png");
        painter.harmonics_ball(convolved_with_cosine(bake.radiance), "harmonics-ball.png");
    });
    const std::vector<MaterialRow> rows = material_rows(bake);
    for (const MaterialRow& row : rows) {
        for (const Material& material : row.materials)
            tasks.emplace_back([&] { painter.material(material); });
    }
    tasks.emplace_back([&] {
        painter.dfg(*bake.dfg, "dfg.png");
        painter.fresnel(bake.options.fresnel, "fresnel.svg");
    });
    detail::parallel_for(
        std::ssize(tasks), [&](std::int64_t i) { tasks[i](); }, progress);
}

}  // namespace mirrorball::cli
