!> The group &friction of the input file: which law, and its constants, by what the library tells
!> about them (docs/laws.md).
module law_input
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use friction_mod, only : broken_rule, constant_table, friction_check, friction_constants, &
        friction_default, friction_law_count, friction_law_name, friction_law_number, &
        law_constant, prop_law, text_length, word_of
    use namelist_input, only : above, at_least, between, namelist_file, rule
    implicit none
    private

    public :: range_of, read_friction, read_law, refuse_orthotropy

    character(len=*), parameter :: group = 'friction'

contains

    !> Constants of the friction law in the order of `props`; every fault is left in `file%faults`.
    subroutine read_friction(file, props, law, means)
        type(namelist_file), intent(inout) :: file
        real(dp), allocatable, intent(out) :: props(:)
        integer, intent(in), optional :: law     !! of `read_law`, if the caller has read it
        logical, intent(in), optional :: means   !! true: of constants that the caller checks
                                                 !! against each other, place by place
        type(constant_table) :: table
        integer :: faults_before, number, place

        faults_before = size(file%faults)
        if (present(law)) then
            number = law
        else
            call read_law(file, number)
        end if
        table = friction_constants(number)
        allocate (props(table%n), source=0.0_dp)
        props(prop_law) = number
        do place = prop_law + 1, table%n
            call read_constant(file, table%of(place), place, props)
        end do
        call point_to_other_laws(file)
        if (present(means)) then
            if (means) return
        end if
        if (size(file%faults) == faults_before .and. file%has_group(group)) call check(file, &
            table, props)
    end subroutine read_friction

    !> The number of the law; if there is something wrong with its name, of the one that most of the
    !> constants fit.
    subroutine read_law(file, number)
        type(namelist_file), intent(inout) :: file
        integer, intent(out) :: number
        character(len=:), allocatable :: law
        character(len=len(friction_law_name(1))) :: names(friction_law_count)
        integer :: faults_before

        names = [(friction_law_name(number), number = 1, friction_law_count)]
        faults_before = size(file%faults)
        call file%get_choice(group, 'law', law, names, default=trim(names(1)))
        if (size(file%faults) == faults_before) then
            number = friction_law_number(law)
        else
            number = minloc([(misfits(file, friction_constants(number)), number = 1, &
                friction_law_count)], dim=1)
        end if
    end subroutine read_law

    !> How many constants of a law are missing, less how many are given?
    integer function misfits(file, table) result(n)
        type(namelist_file), intent(in) :: file
        type(constant_table), intent(in) :: table
        integer, allocatable :: mine(:)
        integer :: place

        n = 0
        do place = prop_law + 1, table%n
            call file%find(group, trim(table%of(place)%name), mine)
            if (size(mine) > 0) then
                n = n - 1
            else if (.not. table%of(place)%optional) then
                n = n + 1
            end if
        end do
    end function misfits

    !> A constant that is given although it belongs to another law is told so.
    subroutine point_to_other_laws(file)
        type(namelist_file), intent(inout) :: file
        type(constant_table) :: table
        integer :: law, place

        do law = 1, friction_law_count
            table = friction_constants(law)
            do place = prop_law + 1, table%n
                call file%belongs_elsewhere(group, trim(table%of(place)%name), &
                    "it belongs to the law '" // trim(friction_law_name(law)) // "'")
            end do
        end do
    end subroutine point_to_other_laws

    subroutine read_constant(file, this, place, props)
        type(namelist_file), intent(inout) :: file
        type(law_constant), intent(in) :: this
        integer, intent(in) :: place
        real(dp), intent(inout) :: props(:)   !! those before it are known
        type(rule) :: allowed

        allowed = range_of(this)
        if (this%whole) then
            call read_choice(file, this, props(place))
        else if (this%optional) then
            call file%get_real(group, trim(this%name), props(place), allowed, &
                default=friction_default(props, place))
        else
            call file%get_real(group, trim(this%name), props(place), allowed)
        end if
    end subroutine read_constant

    !> The rule of a constant by itself.
    pure type(rule) function range_of(this) result(allowed)
        type(law_constant), intent(in) :: this

        allowed = at_least(this%lower)
        if (this%lower > 0.0_dp) allowed = above(0.0_dp)
        if (this%upper < huge(this%upper)) allowed = between(this%lower, this%upper)
    end function range_of

    !> A constant that has words for its values.
    subroutine read_choice(file, this, value)
        type(namelist_file), intent(inout) :: file
        type(law_constant), intent(in) :: this
        real(dp), intent(out) :: value
        character(len=len(this%words)) :: words(0:nint(this%upper))
        character(len=:), allocatable :: word
        integer :: i

        words = [(word_of(this, i), i = 0, nint(this%upper))]
        call file%get_choice(group, trim(this%name), word, words, &
            default=trim(words(nint(this%default))))
        do i = ubound(words, 1), 1, -1
            if (words(i) == word) exit
        end do
        value = real(i, dp)
    end subroutine read_choice

    !> What slides back and forth along one line finds orthotropic friction isotropic.
    subroutine refuse_orthotropy(file, what)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: what   !! slides so, as a plural
        character(len=*), parameter :: keys(2) = ['mu_ratio ', 'direction']
        integer :: i

        do i = 1, size(keys)
            call file%refuse(group, trim(keys(i)), &
                'has no effect on ' // what // ', which slide along one line: it is for the ' &
                // 'verb point')
        end do
    end subroutine refuse_orthotropy

    !> What constants ask of each other.
    subroutine check(file, table, props)
        type(namelist_file), intent(inout) :: file
        type(constant_table), intent(in) :: table
        real(dp), intent(in) :: props(:)
        character(len=text_length) :: text, first
        integer :: place, status, faults_before

        call friction_check(props, place, first, status)
        if (status >= 0) return
        faults_before = size(file%faults)
        do place = prop_law + 1, table%n
            text = broken_rule(table, place, props)
            if (text == '' .or. .not. file%given(group, trim(table%of(place)%name))) cycle
            call file%reject(group, trim(table%of(place)%name), trim(text))
        end do
        if (size(file%faults) == faults_before) call file%add_fault(0, '&friction: ' // trim(first))
    end subroutine check

end module law_input
