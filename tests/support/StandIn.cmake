# add_pfunit_ctest as pFUnit defines it, as far as this project uses it, over the in-tree stand-in.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

add_library(funit_stand_in STATIC support/funit.f90)
set_target_properties(funit_stand_in PROPERTIES Fortran_MODULE_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}/stand_in)
target_include_directories(funit_stand_in PUBLIC ${CMAKE_CURRENT_BINARY_DIR}/stand_in)

function(add_pfunit_ctest name)
    cmake_parse_arguments(arg "" "WORKING_DIRECTORY" "TEST_SOURCES;LINK_LIBRARIES" ${ARGN})
    set(preprocess ${CMAKE_CURRENT_SOURCE_DIR}/support/preprocess_pf.py)
    set(generated ${CMAKE_CURRENT_BINARY_DIR}/${name}.generated)
    file(MAKE_DIRECTORY ${generated})
    add_custom_command(
        OUTPUT ${generated}/tests.F90 ${generated}/main.f90
        COMMAND Python3::Interpreter ${preprocess} ${CMAKE_CURRENT_SOURCE_DIR}/${arg_TEST_SOURCES}
                ${generated}/tests.F90 ${generated}/main.f90
        DEPENDS ${preprocess} ${arg_TEST_SOURCES})
    add_executable(${name} ${generated}/tests.F90 ${generated}/main.f90)
    set_target_properties(${name} PROPERTIES Fortran_MODULE_DIRECTORY ${generated})
    target_link_libraries(${name} PRIVATE funit_stand_in stickslip_flags ${arg_LINK_LIBRARIES})
    add_test(NAME ${name} COMMAND ${name} WORKING_DIRECTORY ${arg_WORKING_DIRECTORY})
endfunction()
