!> Which verb of the program an input is for.
module input_kind
    use namelist_input, only : namelist_file
    implicit none
    private

    public :: refuse_other_verb, verb_of

    !> No verb of this program: the command of the Python package.
    character(len=*), parameter, public :: fitting = 'fit'

contains

    !> By the groups that only it has. Empty if that cannot be told.
    pure function verb_of(file) result(verb)
        type(namelist_file), intent(in) :: file
        character(len=:), allocatable :: verb

        verb = ''
        if (file%line_of_group('slider') > 0 .or. file%line_of_group('drive') > 0) verb = 'run'
        if (file%line_of_group('sweep') > 0) verb = 'sweep'
        if (file%line_of_group('fault') > 0) verb = 'fault'
        if (file%line_of_group('point') > 0) verb = 'point'
        if (file%line_of_group('fit') > 0) verb = fitting
    end function verb_of

    !> Notes a fault if the input is one of another verb, and says of which. Asking for the keys of
    !> the wrong one would only hide that.
    subroutine refuse_other_verb(verb, file, refused)
        character(len=*), intent(in) :: verb
        type(namelist_file), intent(inout) :: file
        logical, intent(out) :: refused
        character(len=:), allocatable :: other, text, command

        other = verb_of(file)
        refused = len(other) > 0 .and. other /= verb
        if (verb == 'stability') refused = any(other == [character(len=5) :: 'point', 'fault', &
            fitting])
        if (.not. refused) return
        command = 'stickslip ' // other
        if (other == fitting) command = 'stickslip-fit'
        text = 'this is an input of the verb ' // other // ', not of ' // verb
        if (verb /= 'run' .and. other == 'run') text = text // ', which needs a group &' // verb
        call file%add_fault(file%line_of_group(other), text // ': ' // command // ' ' // file%name)
    end subroutine refuse_other_verb

end module input_kind
