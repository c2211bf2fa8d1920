#include "program.h"

#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <mirrorball/error.h>

#include "shader_files.h"

namespace mirrorball::gl {
namespace {

std::string_view file_text(std::string_view name) {
    const auto found = shader_files().find(name);
    if (found == shader_files().end())
        throw Error(Errc::unsupported, fmt::format("there is no shader file \"{}\"", name));
    return found->second;
}

// A file's text with what it includes in place.
std::string expanded(std::string_view name) {
    constexpr std::string_view kInclude = "#include \"";
    std::string result;
    std::string_view rest = file_text(name);
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
        const std::string_view line = rest.substr(0, end);
        if (line.starts_with(kInclude)) {
            result += expanded(line.substr(kInclude.size(), line.rfind('"') - kInclude.size()));
        } else {
            result += line;
        }
        rest.remove_prefix(end);
    }
    return result;
}

template <class Get, class GetLog>
std::string log(GLuint name, Get get, GetLog get_log) {
    GLint length = 0;
    get(name, GL_INFO_LOG_LENGTH, &length);
    std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
    get_log(name, length, nullptr, text.data());
    return text.c_str();
}

class Shader {
  public:
    Shader(GLenum stage, std::string_view file, const Definitions& definitions)
        : name_(glCreateShader(stage)) {
        const std::string source = shader_source(file, definitions);
        const char* text = source.c_str();
        glShaderSource(name_, 1, &text, nullptr);
        glCompileShader(name_);
        GLint compiled = GL_FALSE;
        glGetShaderiv(name_, GL_COMPILE_STATUS, &compiled);
        if (!compiled) {
            const std::string message = log(name_, glGetShaderiv, glGetShaderInfoLog);
            glDeleteShader(name_);
            throw Error(Errc::unsupported,
                        fmt::format("the driver does not compile {} ({}): {}", file,
                                    fmt::join(definitions, ", "), message));
        }
    }
    ~Shader() { glDeleteShader(name_); }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;

    [[nodiscard]] GLuint name() const { return name_; }

  private:
    GLuint name_;
};

}  // namespace

std::string shader_source(std::string_view file, const Definitions& definitions) {
    std::string result = is_desktop()
                             ? "#version 450 core\n"
                             : "#version 300 es\nprecision highp float;\nprecision highp int;\n"
                               "precision highp sampler2D;\nprecision highp samplerCube;\n"
                               "precision highp sampler2DArray;\n";
    for (const std::string& definition : definitions) result += "#define " + definition + "\n";
    return result + expanded(file);
}

Program::Program(std::string_view vertex_file, std::string_view fragment_file,
                 const Definitions& definitions, std::string_view geometry_file) {
    const Shader vertex(GL_VERTEX_SHADER, vertex_file, definitions);
    const Shader fragment(GL_FRAGMENT_SHADER, fragment_file, definitions);
    std::optional<Shader> geometry;
    if (!geometry_file.empty())
        geometry.emplace(GLenum{GL_GEOMETRY_SHADER}, geometry_file, definitions);
    name_ = glCreateProgram();
    glAttachShader(name_, vertex.name());
    if (geometry) glAttachShader(name_, geometry->name());
    glAttachShader(name_, fragment.name());
    glLinkProgram(name_);
    GLint linked = GL_FALSE;
    glGetProgramiv(name_, GL_LINK_STATUS, &linked);
    if (!linked) {
        const std::string message = log(name_, glGetProgramiv, glGetProgramInfoLog);
        glDeleteProgram(name_);
        throw Error(Errc::unsupported,
                    fmt::format("the driver does not link {} with {} ({}): {}", vertex_file,
                                fragment_file, fmt::join(definitions, ", "), message));
    }
}

Program::~Program() {
    if (name_ != 0) glDeleteProgram(name_);
}

Program::Program(Program&& other) noexcept
    : name_(std::exchange(other.name_, 0)),
      locations_(std::move(other.locations_)) {}

GLint Program::location(const char* name) const {
    const auto found = locations_.find(name);
    if (found != locations_.end()) return found->second;
    return locations_.emplace(name, glGetUniformLocation(name_, name)).first->second;
}

void Program::set(const char* name, int value) const {
    glUniform1i(location(name), value);
}

void Program::set(const char* name, float value) const {
    glUniform1f(location(name), value);
}

void Program::set(const char* name, const Imath::V2f& value) const {
    glUniform2fv(location(name), 1, value.getValue());
}

void Program::set(const char* name, const Vec3f& value) const {
    glUniform3fv(location(name), 1, value.getValue());
}

// Imath's matrices take rows of vectors from the left, OpenGL's columns from the right: the same
// numbers in the same order.
void Program::set(const char* name, const Imath::M33f& value) const {
    glUniformMatrix3fv(location(name), 1, GL_FALSE, &value.x[0][0]);
}

void Program::set(const char* name, const Imath::M44f& value) const {
    glUniformMatrix4fv(location(name), 1, GL_FALSE, &value.x[0][0]);
}

void Program::set(const char* name, std::span<const Vec3f> values) const {
    if (values.empty()) return;
    glUniform3fv(location(name), static_cast<GLsizei>(values.size()), values.front().getValue());
}

void Program::set(const char* name, std::span<const Imath::V4f> values) const {
    if (values.empty()) return;
    glUniform4fv(location(name), static_cast<GLsizei>(values.size()), &values.front().x);
}

void Program::set(const char* name, std::span<const Imath::M33f> values) const {
    if (values.empty()) return;
    glUniformMatrix3fv(location(name), static_cast<GLsizei>(values.size()), GL_FALSE,
                       &values.front().x[0][0]);
}

void Program::set(const char* name, std::span<const Imath::M44f> values) const {
    if (values.empty()) return;
    glUniformMatrix4fv(location(name), static_cast<GLsizei>(values.size()), GL_FALSE,
                       &values.front().x[0][0]);
}

const Program& ProgramCache::get(std::string_view vertex_file, std::string_view fragment_file,
                                 const Definitions& definitions, std::string_view geometry_file) {
    const std::string key = fmt::format("{} {} {} {}", vertex_file, geometry_file, fragment_file,
                                        fmt::join(definitions, ";"));
    const auto found = programs_.find(key);
    if (found != programs_.end()) return found->second;
    return programs_.emplace(key, Program(vertex_file, fragment_file, definitions, geometry_file))
        .first->second;
}

}  // namespace mirrorball::gl
