# stickslip_export_only(TARGET NAME...): a shared object exports these symbols and no others, and needs
# no libraries but those that it calls. A host that loads it has modules and functions of its own.
function(stickslip_export_only target)
    if(NOT CMAKE_SYSTEM_NAME STREQUAL "Linux")
        return()
    endif()
    set(script ${CMAKE_CURRENT_BINARY_DIR}/${target}.symbols)
    list(JOIN ARGN "; " names)
    file(CONFIGURE OUTPUT ${script} CONTENT "{ global: @names@; local: *; };\n" @ONLY)
    target_link_options(${target} PRIVATE
        -Wl,--as-needed,--gc-sections,--version-script=${script})
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${script})
endfunction()

# stickslip_export_header(TARGET HEADER): the functions that a C header declares.
function(stickslip_export_header target header)
    file(READ ${header} text)
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
    string(REGEX MATCHALL "(friction|stickslip)_[a-z_]+\\(" names "${text}")
    list(TRANSFORM names REPLACE "\\(" "")
    list(REMOVE_DUPLICATES names)
    stickslip_export_only(${target} ${names})
endfunction()
