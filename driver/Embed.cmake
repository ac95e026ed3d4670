# Text files as a Fortran module: embed_texts(FILE TEXT...) writes FILE, in which `get_text` finds each
# text by its name, so that the program needs no folder beside it.
function(embed_texts file)
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
    file(CONFIGURE OUTPUT ${file} CONTENT [[!> The help and the scripts of the pictures, made by CMake.
module embedded_texts
    implicit none
    private

    public :: get_text

@texts@contains

    !> The lines of a text; none if it is unknown.
    pure subroutine get_text(name, lines)
        character(len=*), intent(in) :: name
        character(len=128), allocatable, intent(out) :: lines(:)

        select case (name)
@cases@        case default
            allocate (lines(0))
        end select
    end subroutine get_text

end module embedded_texts
]] @ONLY)
endfunction()
