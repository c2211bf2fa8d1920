# A build for browsers, by Emscripten: WebAssembly with 128-bit vectors, on one thread.
#
# Libraries that are compiled for this machine are of no use there. Of Debian's development packages
# those serve that are headers, or that have their source in one; the rest of what mirrorball can do
# is left out behind the seams in src/core and src/io.

# Emscripten has its own C library, so /usr/include must not be searched. Here are links to what is
# wanted of it and nothing else.
set(header_folder ${PROJECT_BINARY_DIR}/headers)
file(MAKE_DIRECTORY ${header_folder})
foreach(name IN ITEMS Imath hwy fmt nlohmann tiny_gltf.h tiny_obj_loader.h tinyexr.h)
    find_file(HEADERS_${name} ${name} PATHS /usr/include /usr/local/include
        NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH REQUIRED)
    file(CREATE_LINK ${HEADERS_${name}} ${header_folder}/${name} SYMBOLIC)
endforeach()

foreach(target IN ITEMS Imath::Imath hwy::hwy fmt::fmt nlohmann_json::nlohmann_json
                        tinyobjloader::tinyobjloader TinyGLTF::TinyGLTF tinyexr::tinyexr)
    add_library(${target} INTERFACE IMPORTED)
    target_include_directories(${target} SYSTEM INTERFACE ${header_folder})
endforeach()
target_include_directories(Imath::Imath SYSTEM INTERFACE ${header_folder}/Imath)
# Its table of all half floats is in the library.
target_compile_definitions(Imath::Imath INTERFACE IMATH_HALF_NO_LOOKUP_TABLE)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY)
# Pictures in meshes' files are not opened.
target_compile_definitions(TinyGLTF::TinyGLTF INTERFACE TINYGLTF_NO_STB_IMAGE
    TINYGLTF_NO_STB_IMAGE_WRITE TINYGLTF_NO_INCLUDE_STB_IMAGE TINYGLTF_NO_INCLUDE_STB_IMAGE_WRITE)

add_compile_options(-msimd128 -mnontrapping-fptoint -fwasm-exceptions)
add_link_options(-msimd128 -fwasm-exceptions)
# Where Debian has the JavaScript libraries that the linker uses.
set_property(GLOBAL PROPERTY RULE_LAUNCH_LINK
    "${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs")

# Highway 1.0.3 has no vectors of doubles for WebAssembly. Sources that use them take its plain loops
# over 16 bytes instead, of which the compiler makes vector code.
function(use_plain_vectors)
    set_source_files_properties(${ARGN} TARGET_DIRECTORY mirrorball PROPERTIES
        COMPILE_DEFINITIONS HWY_COMPILE_ONLY_EMU128)
endfunction()
