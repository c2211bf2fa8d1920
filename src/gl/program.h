// Programs: shaders out of shaders/, specialised by definitions.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <ImathMatrix.h>

#include <mirrorball/vector.h>

#include "gl.h"

namespace mirrorball::gl {

/// What a program is specialised by: "NAME value" lines put before the shaders as #define.
using Definitions = std::vector<std::string>;

/// The text of a file of shaders/ with `#include "name"` lines replaced by that file, and the
/// definitions in front; complete with the version line of the current context.
[[nodiscard]] std::string shader_source(std::string_view file, const Definitions& definitions);

class Program {
  public:
    /// With a geometry shader in between if its file is named: desktop OpenGL only.
    /// \throws Error(Errc::unsupported) with the driver's log
    Program(std::string_view vertex_file, std::string_view fragment_file,
            const Definitions& definitions = {}, std::string_view geometry_file = {});
    ~Program();
    Program(Program&& other) noexcept;
    Program& operator=(Program&&) = delete;

    void use() const { glUseProgram(name_); }

    // Uniforms of the program in use; those that the program has no use for are passed over.
    void set(const char* name, int value) const;
    void set(const char* name, float value) const;
    void set(const char* name, const Imath::V2f& value) const;
    void set(const char* name, const Vec3f& value) const;
    void set(const char* name, const Vec3d& value) const { set(name, Vec3f(value)); }
    void set(const char* name, const Imath::M33f& value) const;
    void set(const char* name, const Imath::M44f& value) const;
    void set(const char* name, std::span<const Vec3f> values) const;
    void set(const char* name, std::span<const Imath::V4f> values) const;
    void set(const char* name, std::span<const Imath::M33f> values) const;
    void set(const char* name, std::span<const Imath::M44f> values) const;

  private:
    [[nodiscard]] GLint location(const char* name) const;

    GLuint name_ = 0;
    mutable std::map<std::string, GLint, std::less<>> locations_;
};

/// Programs by what they are made of, each compiled when it is first asked for.
class ProgramCache {
  public:
    const Program& get(std::string_view vertex_file, std::string_view fragment_file,
                       const Definitions& definitions = {}, std::string_view geometry_file = {});

  private:
    std::map<std::string, Program> programs_;
};

}  // namespace mirrorball::gl
