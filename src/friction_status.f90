!> Status codes of the library and what they mean in words. `include/friction.h` mirrors them one to
!> one.
module friction_status
    use, intrinsic :: iso_c_binding, only : c_null_char
    implicit none
    private

    public :: friction_message, message_place

    integer, parameter, public :: friction_ok = 0               !! solved, unique
    integer, parameter, public :: friction_snap_back = 1   !! solved, but several equilibria exist
    integer, parameter, public :: friction_bad_size = -1        !! an array has the wrong size
    integer, parameter, public :: friction_bad_law = -2         !! props(1) names no law
    integer, parameter, public :: friction_bad_property = -3  !! a material constant is out of range
    integer, parameter, public :: friction_bad_increment = -4  !! du, pressure or dtime out of range
    integer, parameter, public :: friction_bad_state = -5       !! statev holds what no update wrote
    integer, parameter, public :: friction_no_convergence = -6  !! no equilibrium found
    integer, parameter, public :: friction_bad_normal = -7      !! the normal is not a unit vector
    integer, parameter, public :: friction_null_pointer = -8    !! a pointer from C is NULL
    integer, parameter, public :: friction_zero_time_increment = -9   !! the law needs dtime > 0
    integer, parameter, public :: friction_bad_axis = -10   !! orthotropic friction without an axis
    integer, parameter, public :: friction_no_rate = -11        !! slip starts with a jump

    ! Places of the texts below: one a code, and one for what is no code.
    integer, parameter, public :: first_message = friction_no_rate
    integer, parameter :: unknown = friction_snap_back + 1
    integer, parameter, public :: last_message = unknown
    integer, parameter, public :: message_length = 96

    !> One text a code, ended for C, in the order of the codes; the last is for codes that do not
    !> exist.
    character(len=message_length), parameter, public :: messages(first_message:last_message) = &
        [character(len=message_length) :: &
        'no rate is fast enough: friction falls faster than the contact spring unloads' &
        // c_null_char, &
        'orthotropic friction needs an axis that is not along the normal' // c_null_char, &
        'the law depends on the slip rate: a closed contact under shear needs dtime > 0' &
        // c_null_char, &
        'a pointer argument is NULL' // c_null_char, &
        'the contact normal is not a unit vector' // c_null_char, &
        'no equilibrium found: increment or slip rate beyond the range of the arithmetic' &
        // c_null_char, 'the state variables are out of range or not finite' // c_null_char, &
        'the increment is out of range or not finite, or dtime < 0' // c_null_char, &
        'a material constant is out of range or not finite' // c_null_char, &
        'unknown friction law: props(1) is not the number of a law' // c_null_char, &
        'an array has the wrong size for the friction routine' // c_null_char, &
        'success' // c_null_char, &
        'solved, but several equilibria exist and the contact can snap back: cut the step' &
        // c_null_char, 'unknown status code' // c_null_char]

contains

    !> What a status code says, in one line.
    pure function friction_message(status) result(text)
        integer, intent(in) :: status                  !! a code returned by this library
        character(len=text_length(status)) :: text   !! its meaning; says so if the code is unknown

        text = messages(message_place(status))
    end function friction_message

    !> Its length without the end for C.
    pure function text_length(status) result(length)
        integer, intent(in) :: status   !! a code returned by this library
        integer :: length               !! characters
        integer :: place

        place = message_place(status)
        length = 0
        do while (messages(place)(length + 1:length + 1) /= c_null_char)
            length = length + 1
        end do
    end function text_length

    !> Where the text of a code stands in `messages`.
    pure function message_place(status) result(place)
        integer, intent(in) :: status
        integer :: place

        place = status
        if (status < first_message .or. status > unknown) place = unknown
    end function message_place

end module friction_status
