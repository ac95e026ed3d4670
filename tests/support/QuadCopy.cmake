# The library's sources once more, in quadruple precision: `quad_copies`, for tests to compile.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

get_target_property(originals stickslip_objects SOURCES)
list(REMOVE_ITEM originals friction_c.f90 friction_facts_c.f90)
list(FILTER originals EXCLUDE REGEX "batch|kernel|points|slip_rate")
set(quad_copies)
foreach(source ${originals})
    get_filename_component(name ${source} NAME)
    list(APPEND quad_copies ${CMAKE_CURRENT_BINARY_DIR}/quad/quad_${name})
endforeach()
list(TRANSFORM originals PREPEND ${PROJECT_SOURCE_DIR}/src/)
add_custom_command(OUTPUT ${quad_copies}
    COMMAND Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/quad_copy.py
            ${CMAKE_CURRENT_BINARY_DIR}/quad ${originals}
    DEPENDS ${originals} ${CMAKE_CURRENT_LIST_DIR}/quad_copy.py)
