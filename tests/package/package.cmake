# Installs what was built into a folder of the build tree, then configures, builds and runs the
# consumers beside this file against it.
set(prefix ${CMAKE_CURRENT_BINARY_DIR}/package/prefix)
add_test(NAME package.install
    COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${prefix})
add_test(NAME package.consumer
    COMMAND ${CMAKE_CTEST_COMMAND}
        --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/package ${CMAKE_CURRENT_BINARY_DIR}/package/build
        --build-generator ${CMAKE_GENERATOR} --build-makeprogram ${CMAKE_MAKE_PROGRAM}
        --build-noclean
        --build-options
            -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE}
            -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} -DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}
        --test-command consumer)
set_tests_properties(package.install PROPERTIES FIXTURES_SETUP package)
set_tests_properties(package.consumer PROPERTIES FIXTURES_REQUIRED package)
add_test(NAME package.picture
    COMMAND ${CMAKE_CURRENT_BINARY_DIR}/package/build/picture
    WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/package/build)
add_test(NAME package.viewer COMMAND ${CMAKE_CURRENT_BINARY_DIR}/package/build/viewer)
set_tests_properties(package.picture package.viewer PROPERTIES
    FIXTURES_REQUIRED package DEPENDS package.consumer SKIP_RETURN_CODE 77
    ENVIRONMENT "ASAN_OPTIONS=detect_leaks=0")  # see tests/cli/CMakeLists.txt
