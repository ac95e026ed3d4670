# The scripts of the pictures as a Fortran module: embed_scripts(FILE SCRIPT...) writes FILE, in which
# `get_script` finds each script by its name, so that the program needs no folder beside it.
function(embed_scripts file)
    set(cases "")
    set(texts "")
    foreach(path ${ARGN})
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
        get_filename_component(name ${path} NAME_WE)
        file(READ ${path} text)
        string(REPLACE "'" "''" text "${text}")
        string(REGEX REPLACE "\n$" "" text "${text}")
        string(REPLACE "\n" "', &\n        '" text "${text}")
        string(APPEND texts "    character(len=*), parameter :: ${name}(*) = [character(len=128) :: &\n        '${text}']\n\n")
        string(APPEND cases "        case ('${name}')\n            lines = ${name}\n")
    endforeach()
    file(CONFIGURE OUTPUT ${file} CONTENT [[!> The scripts of output/pictures, made by CMake.
module picture_scripts
    implicit none
    private

    public :: get_script

@texts@contains

    !> The lines of a script; none if it is unknown.
    pure subroutine get_script(name, lines)
        character(len=*), intent(in) :: name
        character(len=128), allocatable, intent(out) :: lines(:)

        select case (name)
@cases@        case default
            allocate (lines(0))
        end select
    end subroutine get_script

end module picture_scripts
]] @ONLY)
endfunction()
