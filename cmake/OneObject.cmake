# Short procedures of many files, linked into one object with calls inlined, take less time (docs/performance_notes.md). It is an
# object as any other, for linkers and hosts that know nothing of this. Gives
#   stickslip_one_object   whether the compiler can
#   stickslip_inlined      options with which such files are compiled
#   stickslip_link_one     the command that links them, without the names of the object and of its parts
# Without -fipa-modref: gfortran 12 has left out stores by it (friction_advance.f90).
set(stickslip_one_object OFF)
if(CMAKE_Fortran_COMPILER_ID STREQUAL "GNU" AND CMAKE_Fortran_COMPILER_VERSION VERSION_GREATER_EQUAL 11
    AND CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT STICKSLIP_STRICT)
    include(CheckIPOSupported)
    check_ipo_supported(RESULT stickslip_one_object OUTPUT reason LANGUAGES Fortran)
endif()
set(stickslip_inlined -flto -fno-ipa-modref -finline-limit=2000 --param=inline-unit-growth=300)
separate_arguments(flags NATIVE_COMMAND "${CMAKE_Fortran_FLAGS}")
set(stickslip_link_one ${CMAKE_Fortran_COMPILER} ${flags} -O3 -fPIC ${stickslip_inlined} -flto-partition=one
    -flinker-output=nolto-rel -r -nostdlib -o)

# stickslip_objects_of(PATTERN SOURCE...): the regular expression that the objects of these sources match
function(stickslip_objects_of pattern)
    list(TRANSFORM ARGN REPLACE ".*/" "")
    list(JOIN ARGN "|" names)
    string(REPLACE "." "[.]" names "/(${names})${CMAKE_Fortran_OUTPUT_EXTENSION}$")
    set(${pattern} "${names}" PARENT_SCOPE)
endfunction()
