# What `cmake --install` puts where: libraries, headers, modules, package files for CMake and pkg-config.
include(CMakePackageConfigHelpers)

foreach(kind shared static)
    target_include_directories(stickslip_${kind} INTERFACE
        $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endforeach()
target_include_directories(stickslip_static INTERFACE
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/stickslip>)

install(TARGETS stickslip_shared stickslip_static EXPORT stickslip
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES ${PROJECT_SOURCE_DIR}/include/friction.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
# Modules differ by compiler; the interface to the C functions is a source file for any of them.
install(DIRECTORY ${modules}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stickslip
    FILES_MATCHING PATTERN "*.mod")
install(FILES ${PROJECT_SOURCE_DIR}/include/friction_interface.f90
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/stickslip)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/stickslip)
install(EXPORT stickslip NAMESPACE stickslip:: FILE stickslip-targets.cmake DESTINATION ${package})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/stickslip-config.cmake.in
    ${CMAKE_CURRENT_BINARY_DIR}/stickslip-config.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/stickslip-config-version.cmake
    COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/stickslip-config.cmake
    ${CMAKE_CURRENT_BINARY_DIR}/stickslip-config-version.cmake DESTINATION ${package})

list(APPEND libraries_behind ${fortran_libraries})
list(JOIN libraries_behind " " libraries_behind)
# A fully static program of gfortran that uses OpenMP ends with a call of this function, which its own
# run-time library refers to weakly, and so leaves out.
set(static_extras)
if(CMAKE_Fortran_COMPILER_ID STREQUAL "GNU" AND OpenMP_Fortran_FOUND AND CMAKE_SYSTEM_NAME STREQUAL "Linux")
    set(static_extras -Wl,-u,pthread_mutex_destroy)
endif()
file(RELATIVE_PATH prefix_from_here /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" prefix_from_here ${prefix_from_here})
foreach(name stickslip stickslip-fortran)
    configure_file(${PROJECT_SOURCE_DIR}/cmake/${name}.pc.in ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc @ONLY)
    install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endforeach()
