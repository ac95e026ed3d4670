# The library's sources once more, for tests to compile: in quadruple precision, `quad_copies`, and with a
# counter of evaluations, `counted_copies`.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

get_target_property(originals stickslip_objects SOURCES)
list(REMOVE_ITEM originals friction_c.f90 friction_c_point.f90 friction_facts_c.f90)
list(FILTER originals EXCLUDE REGEX "batch|lane|kernel|points|slip_rate|threads|\\.c$")
foreach(kind quad counted)
    set(${kind}_copies)
    foreach(source ${originals})
        get_filename_component(name ${source} NAME)
        list(APPEND ${kind}_copies ${CMAKE_CURRENT_BINARY_DIR}/${kind}/${kind}_${name})
    endforeach()
endforeach()
list(TRANSFORM originals PREPEND ${PROJECT_SOURCE_DIR}/src/)
foreach(kind quad counted)
    add_custom_command(OUTPUT ${${kind}_copies}
        COMMAND Python3::Interpreter ${CMAKE_CURRENT_LIST_DIR}/quad_copy.py ${kind}
                ${CMAKE_CURRENT_BINARY_DIR}/${kind} ${originals}
        DEPENDS ${originals} ${CMAKE_CURRENT_LIST_DIR}/quad_copy.py)
endforeach()
