!> Reads what a sweep is told to do: the group &sweep, and the settings of every combination of its
!> values.
module sweep_reader
    use, intrinsic :: iso_fortran_env, only : dp => real64, int64
    use fault_list, only : fault
    use namelist_input, only : any_number, lower, namelist_file
    use run_reader, only : read_settings
    use sweep_settings, only : sweep_axis, sweep_plan
    implicit none
    private

    public :: read_sweep

    integer, parameter :: most_combinations = 10000

contains

    !> Takes the group &sweep from a file, and the settings of each combination by the rules of any
    !> run; every fault of every combination is left in `file%faults`.
    subroutine read_sweep(file, plan)
        type(namelist_file), intent(inout) :: file
        type(sweep_plan), intent(out) :: plan
        type(sweep_axis) :: first, second
        integer :: faults_before

        faults_before = size(file%faults)
        allocate (plan%axes(0), plan%runs(0))
        plan%input = ''
        call file%require_groups(['sweep'])
        call read_axis(file, 'key', 'values', first)
        plan%axes = [plan%axes, first]
        if (file%given('sweep', 'key2') .or. file%given('sweep', 'values2')) then
            call read_axis(file, 'key2', 'values2', second)
            plan%axes = [plan%axes, second]
        end if
        if (size(file%faults) == faults_before) call check_axes(file, plan%axes)
        if (size(file%faults) > faults_before) return
        call read_combinations(file, plan)
        call list_common_input(file, plan)
    end subroutine read_sweep

    subroutine read_axis(file, key_name, values_name, axis)
        type(namelist_file), intent(inout) :: file
        character(len=*), intent(in) :: key_name, values_name   !! keys of &sweep
        type(sweep_axis), intent(out) :: axis
        integer :: percent

        call file%require('sweep', key_name)
        call file%require('sweep', values_name)
        call file%get_text('sweep', key_name, axis%name)
        call file%get_reals('sweep', values_name, axis%values, any_number())
        axis%source = values_name
        axis%name = lower(axis%name)
        percent = index(axis%name, '%')
        axis%group = axis%name(:max(0, percent - 1))
        axis%key = axis%name(percent + 1:)
        if (len(axis%name) == 0) return
        if (len(axis%group) == 0 .or. len(axis%key) == 0 .or. verify(axis%name, &
            'abcdefghijklmnopqrstuvwxyz0123456789_%') > 0) then
            call file%reject('sweep', key_name, "must be 'group%key'")
        else if (axis%group == 'sweep') then
            call file%reject('sweep', key_name, 'must be a key of a run')
        end if
    end subroutine read_axis

    subroutine check_axes(file, axes)
        type(namelist_file), intent(inout) :: file
        type(sweep_axis), intent(in) :: axes(:)
        character(len=80) :: text
        integer(int64) :: combinations
        integer :: i

        combinations = product([(size(axes(i)%values, kind=int64), i = 1, size(axes))])
        write (text, '(a, i0, a, i0)') 'makes ', combinations, &
            ' combinations; the most are ', most_combinations
        if (combinations > most_combinations) call file%reject('sweep', axes(size(axes))%source, &
            trim(text))
        if (size(axes) == 1) return
        if (axes(1)%name == axes(2)%name) call file%reject('sweep', 'key2', 'must differ from key')
    end subroutine check_axes

    !> A value replaces all that the input gives for its key. Each combination is read as if it were
    !> the only one; faults that it shares with an earlier one are not repeated. Those that the
    !> first one does not have come with the values that make them.
    subroutine read_combinations(file, plan)
        type(namelist_file), intent(inout) :: file
        type(sweep_plan), intent(inout) :: plan
        type(fault), allocatable :: faults(:), known(:)
        character(len=:), allocatable :: values
        integer :: places(size(plan%axes)), i, j

        faults = file%faults
        known = file%faults
        deallocate (plan%runs)
        allocate (plan%runs(product([(size(plan%axes(j)%values), j = 1, size(plan%axes))])))
        do i = 1, size(plan%runs)
            places = plan%place(i)
            file%faults = [fault ::]
            values = ''
            do j = 1, size(plan%axes)
                associate (axis => plan%axes(j))
                    call file%substitute(axis%group, axis%key, 'sweep', axis%source, places(j))
                    values = values // ', ' // axis%name // ' = ' // file%value_of(axis%group, &
                        axis%key)
                end associate
            end do
            call read_settings(file, plan%runs(i))
            if (i == 1) values = '  '
            call add_new(faults, known, file%faults, plan%axes, values(3:))
        end do
        call move_alloc(faults, file%faults)
    end subroutine read_combinations

    !> Adds the faults that are not among those known, with the values of the sweep at which they
    !> were met first, if these are told and the fault does not name its own.
    subroutine add_new(faults, known, more, axes, values)
        type(fault), allocatable, intent(inout) :: faults(:), known(:)
        type(fault), intent(in) :: more(:)
        type(sweep_axis), intent(in) :: axes(:)
        character(len=*), intent(in) :: values
        type(fault) :: new
        integer :: i, j
        logical :: own

        do i = 1, size(more)
            if (any([(known(j)%line == more(i)%line .and. known(j)%text == more(i)%text, j = 1, &
                size(known))])) cycle
            known = [known, more(i)]
            new = more(i)
            own = any([(index(new%text, '&' // axes(j)%group // ' ' // axes(j)%key // ' = ') &
                == 1, j = 1, size(axes))])
            if (len(values) > 0 .and. .not. own) new%text = new%text // ' (at ' // values // ')'
            faults = [faults, new]
        end do
    end subroutine add_new

    subroutine list_common_input(file, plan)
        type(namelist_file), intent(inout) :: file
        type(sweep_plan), intent(inout) :: plan
        integer :: i

        do i = 1, size(plan%axes)
            call file%remove(plan%axes(i)%group, plan%axes(i)%key)
            call file%remove('sweep', plan%axes(i)%source)
        end do
        plan%input = file%listing(without='')
    end subroutine list_common_input

end module sweep_reader
