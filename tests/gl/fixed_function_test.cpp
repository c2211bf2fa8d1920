// The fixed functions of old, glTexGen and texture matrices, against our methods that work per
// vertex. The same textures, the same triangles, unlit, into floats.
//
// What differs is rounding only. Places on maps are found at the vertices to some 1e-6, and
// vertices on the screen are rounded to 1/256 pixel or finer, each way of drawing from its own
// product of matrices. So a picture may be moved by 1/256 pixel: a pixel may differ by 1/128 of the
// largest step to a neighbour (one pixel of rounding up, one down), plus 1/4000 for filters. The
// sphere map is made on the processor for one and on the graphics card for the other, rounded to
// half floats after two filters: 1/1000 more.
#include <gtest/gtest.h>

#include "gl/gl.h"
#include "gl/target.h"
#include "gl/texture.h"
#include "gl_test.h"
#include "warped_map.h"

namespace mirrorball::gl {
namespace {

constexpr int kWidth = 200, kHeight = 150;

// The numbers of Imath's matrices for rows are OpenGL's for columns.
void load(GLenum mode, const Imath::M44d& m) {
    glMatrixMode(mode);
    glLoadMatrixd(&m[0][0]);
}

Imath::M44d turned_by(const Axes& axes) {
    const auto& [x, y, z] = axes;
    return {x.x, y.x, z.x, 0, x.y, y.y, z.y, 0, x.z, y.z, z.z, 0, 0, 0, 0, 1};
}

// The scene's camera, as one would have written it then.
void look_from(const Camera& camera, double aspect) {
    const double height = 0.01 * std::tan(camera.field_of_view / 2);
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
    glFrustum(-height * aspect, height * aspect, -height, height, 0.01, 100);
    load(GL_MODELVIEW, turned_by(axes(camera)));
    glTranslated(-camera.eye.x, -camera.eye.y, -camera.eye.z);
}

void draw(const Mesh& mesh) {
    glEnableClientState(GL_VERTEX_ARRAY);
    glEnableClientState(GL_NORMAL_ARRAY);
    glVertexPointer(3, GL_FLOAT, 0, mesh.positions.data());
    glNormalPointer(GL_FLOAT, 0, mesh.normals.data());
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.indices.size()), GL_UNSIGNED_INT,
                   mesh.indices.data());
}

// Radiance where the object is, and alpha 0 elsewhere.
Image draw_with_texgen(const Scene& scene, const SceneAssets& assets, const Texture& map,
                       GLint mode, const Imath::M44d& texture_matrix) {
    // No program, and arrays from the program's own memory.
    glUseProgram(0);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    const Target target(kWidth, kHeight);
    target.bind();
    glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_FALSE);
    glClampColor(GL_CLAMP_READ_COLOR, GL_FALSE);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glEnable(GL_DEPTH_TEST);
    glDisable(GL_LIGHTING);
    glEnable(GL_NORMALIZE);
    glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);

    map.bind(0);
    glEnable(map.target);
    glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
    for (const GLenum coordinate : {GL_S, GL_T, GL_R}) {
        if (coordinate == GL_R && mode == GL_SPHERE_MAP) continue;
        glTexGeni(coordinate, GL_TEXTURE_GEN_MODE, mode);
        glEnable(coordinate == GL_S   ? GL_TEXTURE_GEN_S
                 : coordinate == GL_T ? GL_TEXTURE_GEN_T
                                      : GL_TEXTURE_GEN_R);
    }
    load(GL_TEXTURE, texture_matrix);
    look_from(scene.camera, static_cast<double>(kWidth) / kHeight);
    const SceneObject& object = scene.objects[0];
    glMultMatrixd(&matrix(object.transform)[0][0]);
    draw(assets.meshes.at(object.mesh));

    Image result = target.read(4);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return result;
}

class FixedFunction : public GlTest {
  protected:
    // `factor` is what the material does to the light.
    void compare(const std::string& mesh, Method method, const Material& material, GLint mode,
                 double factor) {
        const auto assets = assets_in(builtin_environment("sunset"));
        Scene scene = scene_with(mesh, material, method);
        scene.objects[0].transform = {{0.1, 0.05, 0}, 0.4, 0.3, 0.2, {1, 0.9, 1.1}};
        scene.environment.background = false;

        use(Api::core);
        const Image ours = [&] {
            Renderer renderer(assets);
            return radiance(renderer, scene, kWidth, kHeight);
        }();
        use(Api::compatibility);
        const ReflectionMaps maps =
            make_reflection_maps(assets->environment, {}, Projection::cube, scene.map_size,
                                 default_axes(Projection::cube));
        const Axes camera = axes(scene.camera);
        const Image theirs = [&] {
            if (mode == GL_SPHERE_MAP) {
                // t grows down, as rows are stored
                const Imath::M44d flipped(1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1);
                const EnvironmentMap sphere = warped(maps.mirror, Projection::sphere, camera);
                return draw_with_texgen(scene, *assets, upload(sphere.levels[0].faces[0], true),
                                        mode, flipped);
            }
            // From the eye's frame back to the world, which the cube is fixed in.
            return draw_with_texgen(
                scene, *assets, upload(mode == GL_NORMAL_MAP ? maps.diffuse : maps.mirror), mode,
                turned_by(camera).transposed() * turned_by(maps.mirror.axes));
        }();
        compare(ours, theirs, factor, mode == GL_SPHERE_MAP ? 1.0 / 800 : 1.0 / 4000,
                mesh + ", " + std::string(name(method)));
    }

  private:
    static void compare(const Image& ours, const Image& theirs, double factor, double rounding,
                        const std::string& what) {
        const auto shown = [&](double radiance) {
            return srgb(tone_mapped(static_cast<float>(radiance), 1));
        };
        int covered = 0, differently_covered = 0, wrong = 0;
        double largest = 0;
        for (int y = 1; y + 1 < kHeight; ++y) {
            for (int x = 1; x + 1 < kWidth; ++x) {
                const bool is_there = theirs.at(x, y)[3] > 0;
                if (is_there != (ours.rgb(x, y).length() > 0)) ++differently_covered;
                if (!is_there) continue;
                ++covered;
                bool differs = false;
                for (int c = 0; c < 3; ++c) {
                    const auto at = [&](int i, int j) {
                        return shown(factor * theirs.at(x + i, y + j)[c]);
                    };
                    double step = 0;
                    for (int j = -1; j <= 1; ++j)
                        for (int i = -1; i <= 1; ++i)
                            step = std::max(step, std::abs(at(i, j) - at(0, 0)));
                    const double error = std::abs(shown(ours.rgb(x, y)[c]) - at(0, 0));
                    largest = std::max(largest, error);
                    differs = differs || !(error <= step / 128 + rounding);
                }
                if (differs) ++wrong;
            }
        }
        EXPECT_GT(covered, 3000) << what;
        // A pixel's centre may lie on an edge, to rounding: of the silhouette, or between flat
        // faces.
        EXPECT_LE(differently_covered, covered / 500) << what;
        EXPECT_LE(wrong, covered / 1000) << what << ": largest difference " << largest;
    }
};

TEST_F(FixedFunction, SphereMapIsSphereVertex) {
    for (const char* mesh : {"sphere", "torus", "teapot", "cube"})
        compare(mesh, Method::sphere_vertex, mirror_material(), GL_SPHERE_MAP, 1);
}

TEST_F(FixedFunction, ReflectionMapIsCubeVertex) {
    for (const char* mesh : {"sphere", "torus", "teapot", "cube"})
        compare(mesh, Method::cube_vertex, mirror_material(), GL_REFLECTION_MAP, 1);
}

TEST_F(FixedFunction, NormalMapIsDiffuseLight) {
    for (const char* mesh : {"sphere", "torus", "teapot", "cube"})
        compare(mesh, Method::cube_vertex, diffuse_material(), GL_NORMAL_MAP, 1 / kPi);
}

}  // namespace
}  // namespace mirrorball::gl
