!> A file of namelist groups, which the program asks for each key that it knows, with its type, rule
!> and default.
module namelist_input
    use, intrinsic :: ieee_arithmetic, only : ieee_is_finite
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use namelist_content, only : content
    use namelist_parser, only : value_token
    use namelist_rules, only : above, any_number, at_least, between, not_zero, rule
    use number_reader, only : largest, read_number
    use number_text, only : whole_text
    use printable_text, only : lower
    use similar_words, only : most_similar
    use whole_file, only : plain_text, read_whole_file
    implicit none
    private

    public :: above, any_number, at_least, between, lower, namelist_file, not_zero, &
        read_logical, read_namelist_file, read_namelist_text, rule

    integer, parameter :: most_of_a_list = 10   !! of its values that are refused one by one

    type, extends(content) :: namelist_file
    contains
        procedure :: get_real, get_reals, get_integer, get_choice, get_choices, get_text, &
            get_logical
    end type namelist_file

contains

    !> Reads a file whole and takes it apart. `problem` is empty unless the file cannot be read.
    subroutine read_namelist_file(name, file, problem)
        character(len=*), intent(in) :: name
        type(namelist_file), intent(out) :: file
        character(len=:), allocatable, intent(out) :: problem
        character(len=:), allocatable :: text

        call read_whole_file(name, text, problem)
        call file%take_text(name, text)
    end subroutine read_namelist_file

    !> Takes a text apart that is in memory already.
    subroutine read_namelist_text(name, text, file, problem)
        character(len=*), intent(in) :: name   !! for messages; files beside it are looked for there
        character(len=*), intent(in) :: text
        type(namelist_file), intent(out) :: file
        character(len=:), allocatable, intent(out) :: problem
        character(len=:), allocatable :: lines

        call plain_text(text, lines, problem)
        if (len(problem) > 0) lines = ''
        call file%take_text(name, lines)
    end subroutine read_namelist_text

    !> A number. Without a default, leaving the key out is a fault.
    subroutine get_real(self, group, key, value, allowed, default)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        real(dp), intent(out) :: value
        type(rule), intent(in) :: allowed
        real(dp), intent(in), optional :: default
        type(value_token) :: token
        character(len=:), allocatable :: why
        logical :: found

        value = 0.0_dp
        if (present(default)) value = default
        if (.not. self%given(group, key)) then
            if (.not. present(default)) call self%require(group, key)
            return
        end if
        call take_one(self, group, key, token, found)
        if (.not. found) return
        call take_number(token, allowed, value, found, why)
        if (len(why) > 0) call self%reject(group, key, why)
    end subroutine get_real

    !> A list of numbers; empty if the key is not given or one of its values is no number.
    subroutine get_reals(self, group, key, values, allowed)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        real(dp), allocatable, intent(out) :: values(:)
        type(rule), intent(in) :: allowed
        type(value_token), allocatable :: tokens(:)
        character(len=:), allocatable :: why
        integer :: refused, i
        logical :: sound

        call self%gather(group, key, tokens)
        allocate (values(size(tokens)))
        sound = .true.
        refused = 0
        do i = 1, size(tokens)
            call take_number(tokens(i), allowed, values(i), sound, why)
            if (len(why) == 0) cycle
            refused = refused + 1
            if (refused <= most_of_a_list) call self%reject(group, key, why, token=tokens(i))
        end do
        if (refused > most_of_a_list) call self%reject(group, key, whole_text(refused &
            - most_of_a_list) // ' more of its values are refused')
        if (.not. sound) values = [real(dp) ::]
    end subroutine get_reals

    subroutine take_number(token, allowed, value, sound, why)
        type(value_token), intent(in) :: token
        type(rule), intent(in) :: allowed
        real(dp), intent(out) :: value                       !! 0 where there is no number
        logical, intent(inout) :: sound                      !! false where there is no number
        character(len=:), allocatable, intent(out) :: why    !! it is refused; or empty
        logical :: is_number, too_small

        why = ''
        call read_number(token%text, value, is_number, too_small)
        if (token%quoted .or. .not. is_number) then
            why = 'must be a number'
        else if (.not. ieee_is_finite(value)) then
            why = 'must be finite'
            if (scan(token%text, '0123456789') > 0) why = 'must be finite: it exceeds the ' &
                // 'largest number, 1.8e308'
        else if (too_small) then
            why = 'is not 0, but below the smallest number, 4.9e-324'
        else if (abs(value) > largest) then
            why = 'must not exceed 1e100 in size'
        else if (.not. allowed%holds(value)) then
            why = 'must be ' // allowed%text
            return
        end if
        if (len(why) == 0) return
        value = 0.0_dp   ! no later rule is asked of what is no number
        sound = .false.
    end subroutine take_number

    !> A whole number.
    subroutine get_integer(self, group, key, value, allowed, default)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        integer, intent(out) :: value
        type(rule), intent(in) :: allowed
        integer, intent(in) :: default
        real(dp) :: number

        call self%get_real(group, key, number, allowed, default=real(default, dp))
        value = default
        if (abs(number) > real(huge(value), dp)) then
            call self%reject(group, key, 'must be a whole number up to 2147483647')
        else if (abs(number - anint(number)) > 0.0_dp) then
            call self%reject(group, key, 'must be a whole number')
        else
            value = nint(number)
        end if
    end subroutine get_integer

    !> One of a few texts.
    subroutine get_choice(self, group, key, value, choices, default)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        character(len=:), allocatable, intent(out) :: value
        character(len=*), intent(in) :: choices(:)
        character(len=*), intent(in) :: default
        type(value_token) :: token
        integer :: place
        logical :: found

        value = default
        call take_one(self, group, key, token, found)
        if (.not. found) return
        call take_choice(self, group, key, token, choices, place)
        if (place > 0) value = trim(choices(place))
    end subroutine get_choice

    !> A list of texts of which each is one of a few, as places in `choices`; empty if the key is
    !> not given or one of its values is none of them.
    subroutine get_choices(self, group, key, places, choices)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        integer, allocatable, intent(out) :: places(:)
        character(len=*), intent(in) :: choices(:)
        type(value_token), allocatable :: tokens(:)
        integer :: i

        call self%gather(group, key, tokens)
        allocate (places(size(tokens)))
        do i = 1, size(tokens)
            call take_choice(self, group, key, tokens(i), choices, places(i))
        end do
        if (any(places == 0)) places = [integer ::]
    end subroutine get_choices

    subroutine take_choice(self, group, key, token, choices, place)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        type(value_token), intent(in) :: token
        character(len=*), intent(in) :: choices(:)
        integer, intent(out) :: place   !! in `choices`; 0: it is none of them, a fault
        character(len=:), allocatable :: list

        do place = size(choices), 1, -1
            if (choices(place) == lower(token%text) .and. token%quoted) return
        end do
        list = "'" // trim(choices(1)) // "'"
        do place = 2, size(choices)
            list = list // ", '" // trim(choices(place)) // "'"
        end do
        if (size(choices) > 1) list = 'one of ' // list
        if (.not. token%quoted) list = 'text in quotes, ' // list
        place = most_similar(lower(token%text), choices)
        if (token%quoted .and. place > 0) list = list // "; did you mean '" &
            // trim(choices(place)) // "'?"
        call self%reject(group, key, 'must be ' // list, token=token)
        place = 0
    end subroutine take_choice

    !> Any text in quotes; empty if the key is not given.
    subroutine get_text(self, group, key, value)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        character(len=:), allocatable, intent(out) :: value
        type(value_token) :: token
        logical :: found

        value = ''
        call take_one(self, group, key, token, found)
        if (.not. found) return
        if (token%quoted .and. len_trim(token%text) > 0) then
            value = token%text
        else
            call self%reject(group, key, 'must be text in quotes')
        end if
    end subroutine get_text

    !> True or false, as Fortran writes it.
    subroutine get_logical(self, group, key, value, default)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        logical, intent(out) :: value
        logical, intent(in) :: default
        type(value_token) :: token
        logical :: found, is_logical

        value = default
        call take_one(self, group, key, token, found)
        if (.not. found) return
        call read_logical(token%text, value, is_logical)
        if (.not. is_logical .or. token%quoted) call self%reject(group, key, &
            'must be .true. or .false.')
    end subroutine get_logical

    pure subroutine read_logical(text, value, is_logical)
        character(len=*), intent(in) :: text
        logical, intent(out) :: value, is_logical
        character(len=7), parameter :: yes(6) = [character(len=7) :: '.true.', '.true', '.t.', &
            '.t', 'true', 't']
        character(len=7), parameter :: no(6) = [character(len=7) :: '.false.', '.false', '.f.', &
            '.f', 'false', 'f']

        value = any(yes == lower(text))
        is_logical = value .or. any(no == lower(text))
    end subroutine read_logical

    !> The value of a key that takes one.
    subroutine take_one(self, group, key, token, found)
        class(namelist_file), intent(inout) :: self
        character(len=*), intent(in) :: group, key
        type(value_token), intent(out) :: token
        logical, intent(out) :: found   !! false if the key is not given, or something is wrong
        type(value_token), allocatable :: tokens(:)
        integer, allocatable :: mine(:)

        found = .false.
        if (.not. self%given(group, key)) return
        call self%find(group, key, mine)
        if (any(self%entries(mine)%subscripted)) then
            call self%reject(group, key, 'takes one value, and no subscript')
            return
        end if
        call self%gather(group, key, tokens)
        found = size(tokens) == 1
        if (found) token = tokens(1)
        if (size(tokens) > 1) call self%reject(group, key, 'takes one value, not ' &
            // whole_text(size(tokens)))
    end subroutine take_one

end module namelist_input
