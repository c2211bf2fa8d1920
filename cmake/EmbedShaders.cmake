# Turns the shader files into one C++ file that holds their text, so that the library needs no file
# when it runs:
#
#     cmake -D SHADERS=a.glsl;b.frag -D OUTPUT=shader_files.cpp -P EmbedShaders.cmake
set(entries "")
foreach(path IN LISTS SHADERS)
    get_filename_component(name ${path} NAME)
    file(READ ${path} text)
    string(APPEND entries "    {\"${name}\", R\"glsl(${text})glsl\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made of the files in shaders/ by cmake/EmbedShaders.cmake.
#include \"gl/shader_files.h\"

namespace mirrorball::gl {

const std::map<std::string_view, std::string_view>& shader_files() {
    static const std::map<std::string_view, std::string_view> files = {
${entries}    };
    return files;
}

}  // namespace mirrorball::gl
")
