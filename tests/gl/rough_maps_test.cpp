// The maps of every roughness as shaders look them up, next to look_up_rough().
#include <cmath>

#include <gtest/gtest.h>
#include <mirrorball/projections/equirect.h>
#include <mirrorball/reflection_maps.h>

#include "gl/check.h"
#include "gl/program.h"
#include "gl/scene_maps.h"
#include "gl/shader_files.h"
#include "gl/target.h"
#include "gl_test.h"

namespace mirrorball::gl {
namespace {

class RoughMapsTest : public GlTest {};

constexpr int kFace = 32;

// Shaders for the current context, with definitions in front: the texts of files, one after the
// other, and more.
std::string with_header(const std::string& method, const std::string& more) {
    const std::string methods = shader_source("methods.glsl", {});
    const std::string header =
        methods.substr(0, methods.size() - shader_files().at("methods.glsl").size());
    const auto text = [&](const char* file) {
        return shader_source(file, {}).substr(header.size());
    };
    return header + "#define METHOD " + method +
           "\n#define HAS_ROUGH_MAP\n#define PROXY NO_PROXY\n" + text("methods.glsl") +
           text("proxy.glsl") + text("light_per_pixel.glsl") + more;
}

GLuint compiled(GLenum stage, const std::string& source) {
    const GLuint shader = glCreateShader(stage);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint is_compiled = GL_FALSE;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_compiled);
    char log[1000] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    EXPECT_TRUE(is_compiled) << log;
    return shader;
}

// A picture of what rough_light() gives for all directions, as a panorama shows them.
constexpr int kWidth = 256;
constexpr const char* kMain = R"(
uniform float u_alpha;
uniform vec2 u_picture;
out vec4 o_color;

void main() {
    vec2 st = gl_FragCoord.xy / u_picture;
    o_color = vec4(rough_light(equirect_direction(vec2(st.x, 1.0 - st.y)), u_alpha), 1.0);
}
)";

std::string glsl_name(Method method) {
    std::string text(name(method));
    if (method == Method::sphere_stale) text = "sphere";
    for (char& letter : text) letter = letter == '-' ? '_' : static_cast<char>(toupper(letter));
    return text;
}

class RoughPicture {
  public:
    explicit RoughPicture(const std::string& method) : program_(glCreateProgram()) {
        const GLuint vertex = compiled(GL_VERTEX_SHADER, shader_source("full.vert", {}));
        const GLuint fragment = compiled(GL_FRAGMENT_SHADER, with_header(method, kMain));
        glAttachShader(program_, vertex);
        glAttachShader(program_, fragment);
        glLinkProgram(program_);
        glDeleteShader(vertex);
        glDeleteShader(fragment);
    }
    ~RoughPicture() { glDeleteProgram(program_); }
    RoughPicture(const RoughPicture&) = delete;
    RoughPicture& operator=(const RoughPicture&) = delete;

    [[nodiscard]] Image operator()(const LookupMaps& maps, double alpha) const {
        glUseProgram(program_);
        const auto at = [&](const char* uniform) {
            return glGetUniformLocation(program_, uniform);
        };
        const Imath::M33f to_map = to_map_matrix(maps.axes);
        glUniformMatrix3fv(at("u_to_map"), 1, GL_FALSE, &to_map.x[0][0]);
        glUniform1i(at("u_mirror_map"), 0);
        glUniform1i(at("u_rough_map"), 1);
        maps.textures->mirror.bind(0);
        maps.textures->rough.bind(1);
        glUniform1f(at("u_rough_levels"), static_cast<float>(maps.textures->rough.level_count));
        glUniform1f(at("u_mirror_alpha"), static_cast<float>(maps.mirror_alpha));
        glUniform1f(at("u_alpha"), static_cast<float>(alpha));
        glUniform2f(at("u_picture"), kWidth, kWidth / 2);
        const Target target(kWidth, kWidth / 2);
        target.bind();
        glViewport(0, 0, kWidth, kWidth / 2);
        glDisable(GL_DEPTH_TEST);
        make_cubes_seamless();
        glBindVertexArray(nothing_.name());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        check("drawing what is rough");
        return target.read(3);
    }

  private:
    GLuint program_;
    VertexArray nothing_;
};

// The root mean square over the sphere of what pixels are off by, over that of what there is.
template <class Expected>
double error_of(const Image& picture, Expected&& expected) {
    double error = 0, light = 0;
    for (int y = 0; y < picture.height(); ++y) {
        for (int x = 0; x < picture.width(); ++x) {
            const FacePoint<double> place{0, (x + 0.5) / picture.width(),
                                          (y + 0.5) / picture.height()};
            // equirect_direction() is in the frame of a panorama that stands upright
            const Vec3d d = Equirect::direction(place);
            const Vec3f truth = expected(d);
            const double area = std::hypot(d.x, d.z);
            error += area * (picture.rgb(x, y) - truth).length2();
            light += area * truth.length2();
        }
    }
    return std::sqrt(error / light);
}

bool has_rim(Method method) {
    const Projection projection = projection_of(method);
    return projection == Projection::sphere || projection == Projection::dual_paraboloid;
}

// Half floats and the filter's weights of 8 bits: 5e-4. Texels that are filtered without those
// across the edge of a face are off at the small levels of cubes with seams. Maps with rims are
// looked up twice, once when they are made; at the last level a sphere map has 16 texels across,
// and what is behind it in the outermost of them.
double tolerance(Method method) {
    if (projection_of(method) == Projection::sphere) return 0.07;
    if (has_rim(method)) return 0.012;
    return method == Method::cube_seams ? 0.012 : 0.001;
}

Projection made_in(Method method) {
    const Projection projection = projection_of(method);
    return projection == Projection::equirect || projection == Projection::octahedral
               ? projection
               : Projection::cube;
}

int size_of(Projection projection) {
    return projection == Projection::equirect     ? 4 * kFace
           : projection == Projection::octahedral ? 2 * kFace
                                                  : kFace;
}

constexpr Method kPerPixel[] = {Method::sphere,     Method::sphere_stale,    Method::cube,
                                Method::cube_seams, Method::dual_paraboloid, Method::equirect,
                                Method::octahedral};

std::shared_ptr<LobeFilter> filter_of(const EnvironmentMap& map) {
    return std::make_shared<LobeFilter>(std::make_shared<const EnvironmentMap>(map));
}

void expect_rough_light(Method method) {
    SCOPED_TRACE(name(method));
    const EnvironmentMap& sky = builtin_environment("studio");
    const Projection projection = made_in(method);
    const ReflectionMaps expected = make_reflection_maps(sky, {}, projection, size_of(projection),
                                                         default_axes(projection), {.rough = true});
    SceneMaps maps(filter_of(sky), method, kFace, true);
    const bool is_stale = method == Method::sphere_stale;  // right for this camera only
    maps.look_from(axes(is_stale ? Camera{} : Camera{{1, 2, 3}}), {});
    const LookupMaps lookup = maps.lookup({}, {});
    ASSERT_FALSE(lookup.textures->rough.empty());
    EXPECT_EQ(lookup.textures->rough.level_count, expected.rough.level_count());
    const RoughPicture picture(glsl_name(method));
    for (const double alpha : {0.0, 0.03, 0.0625, 0.1, 0.25, 0.35, 1.0, 2.0}) {
        if (alpha < 0.06 && has_rim(method)) continue;  // how sharp mirrors are is not at stake
        const double error = error_of(picture(lookup, alpha), [&](const Vec3d& d) {
            return look_up_rough(expected, d, alpha);
        });
        EXPECT_LT(error, tolerance(method)) << alpha;
    }
}

TEST_F(RoughMapsTest, EveryMethodPerPixelShowsThem) {
    for (const Method method : kPerPixel) expect_rough_light(method);
}

TEST_F(RoughMapsTest, SoItDoesInOpenGlEs) {
    use(Api::es);
    for (const Method method : {Method::cube, Method::cube_seams, Method::sphere})
        expect_rough_light(method);
}

TEST_F(RoughMapsTest, OnlyWhereTheyAreAskedForAndLookedUp) {
    const EnvironmentMap& sky = builtin_environment("studio");
    for (const Method method : all_methods()) {
        const bool per_pixel =
            std::find(std::begin(kPerPixel), std::end(kPerPixel), method) != std::end(kPerPixel);
        const SceneMaps asked(filter_of(sky), method, kFace, true),
            not_asked(filter_of(sky), method, kFace);
        EXPECT_EQ(asked.lookup({}, {}).textures->rough.empty(), !per_pixel) << name(method);
        EXPECT_TRUE(not_asked.lookup({}, {}).textures->rough.empty()) << name(method);
        EXPECT_EQ(asked.bytes() > not_asked.bytes(), per_pixel) << name(method);
    }
}

}  // namespace
}  // namespace mirrorball::gl
