!> The pictures of a run, of a chain's events and fields, of a contact point's path, and of a sweep.
module run_pictures
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use block_table, only : block_columns, column_label
    use chain_fields, only : sample_fields
    use law_facts, only : internal_variable
    use loading_path, only : point_run
    use number_text, only : short_text, whole_text
    use picture, only : picture_values
    use run_settings, only : settings
    use sweep_settings, only : sweep_plan
    implicit none
    private

    public :: draw_blocks, draw_catalogue, draw_fields, draw_point, draw_run, draw_sweep

contains

    !> DIRECTORY/STEM.png, from the time series in FILE. `problem` says what went wrong.
    subroutine draw_run(run, directory, stem, file, problem)
        type(settings), intent(in) :: run
        character(len=*), intent(in) :: directory, stem
        character(len=*), intent(in) :: file   !! in that directory
        character(len=:), allocatable, intent(out) :: problem
        real(dp), parameter :: smallest_part = 1.0e-9_dp   !! of the drive's speed, as a slip rate
        type(picture_values) :: values

        call values%begin(stem, file, run%units)
        call values%set('area', run%area)
        call values%set('internal', trim(internal_variable(run%props)))
        call values%set('slowest', smallest_part * maxval(abs(run%drive%velocity)))
        call values%set('thinned', merge(0, 1, file == stem // '.csv'))
        if (run%across%free()) then
            call values%draw('run_two_way', directory, stem, problem)
        else if (internal_variable(run%props) == 'theta') then
            call values%draw('run_rate_state', directory, stem, problem)
        else
            call values%draw('run', directory, stem, problem)
        end if
    end subroutine draw_run

    !> DIRECTORY/STEM_events.png, from the catalogue of a chain.
    subroutine draw_catalogue(run, directory, stem, problem)
        type(settings), intent(in) :: run
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem
        type(picture_values) :: values

        call values%begin(stem // '_events', stem // '_events.csv', run%units)
        call values%draw('catalogue', directory, stem // '_events', problem)
    end subroutine draw_catalogue

    !> DIRECTORY/STEM_blocks.png, from the table of what differs from block to block.
    subroutine draw_blocks(run, directory, stem, problem)
        type(settings), intent(in) :: run
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem
        integer, parameter :: most_points = 20000
        type(picture_values) :: values
        integer, allocatable :: columns(:)
        integer :: k

        allocate (columns, source=block_columns(run))
        call values%begin(stem // '_blocks', stem // '_blocks.csv', run%units)
        call values%set('panels', size(columns))
        call values%set('step', (run%chain%n_blocks - 1) / most_points + 1)
        do k = 1, size(columns)
            call values%set('label_' // whole_text(k), column_label(run, columns(k)))
        end do
        call values%draw('blocks', directory, stem // '_blocks', problem)
    end subroutine draw_blocks

    !> DIRECTORY/STEM_fields.png, from the fields of a chain.
    subroutine draw_fields(run, directory, stem, problem)
        type(settings), intent(in) :: run
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem
        real(dp), parameter :: shown = 0.01_dp   !! least slip rate, part of that of an event
        type(picture_values) :: values
        logical :: sampled

        call sample_fields(directory // '/' // stem, run%chain%n_blocks, sampled)
        if (.not. sampled) then
            problem = 'the fields cannot be sampled for a picture'
            return
        end if
        call values%begin(stem // '_fields', stem // '_fields.dat', run%units)
        call values%set('least', shown * run%chain%slip_rate)
        call values%draw('fields', directory, stem // '_fields', problem)
    end subroutine draw_fields

    !> DIRECTORY/STEM.png, from the rows of a path.
    subroutine draw_point(run, directory, stem, problem)
        type(point_run), intent(in) :: run
        character(len=*), intent(in) :: directory, stem
        character(len=:), allocatable, intent(out) :: problem
        real(dp), parameter :: most_points = 1.0e5_dp
        type(picture_values) :: values

        call values%begin(stem, stem // '.csv', run%units)
        call values%set('directions', run%loading%ndir)
        call values%set('step', max(1, ceiling(run%loading%increments() / most_points)))
        call values%draw('point', directory, stem, problem)
    end subroutine draw_point

    !> DIRECTORY/STEM.png, from the table of a sweep: curves over one key, a map over two.
    subroutine draw_sweep(plan, directory, stem, found, problem)
        type(sweep_plan), intent(in) :: plan
        character(len=*), intent(in) :: directory, stem
        integer, intent(in) :: found   !! combinations that stick and slip
        character(len=:), allocatable, intent(out) :: problem
        type(picture_values) :: values

        call values%begin(stem, stem // '.csv', plan%runs(1)%units)
        call values%set('found', found)
        call values%set('key_1', plan%axes(1)%name)
        if (size(plan%axes) == 1) then
            associate (x => plan%axes(1)%values)
                call values%set('over_decades', merge(1, 0, minval(x) > 0.0_dp .and. maxval(x) &
                    >= 10.0_dp * minval(x)))
                call values%set('lowest', minval(x))
                call values%set('highest', maxval(x))
            end associate
            call values%draw('sweep_curves', directory, stem, problem)
        else
            call values%set('key_2', plan%axes(2)%name)
            call values%set('right_cells', size(plan%axes(1)%values))
            call values%set('up_cells', size(plan%axes(2)%values))
            call values%set('tics_1', tics(plan%axes(1)%values))
            call values%set('tics_2', tics(plan%axes(2)%values))
            call values%draw('sweep_map', directory, stem, problem)
        end if
    end subroutine draw_sweep

    !> Labels of the places of the values, in six digits; of many values every so many, so that they
    !> can be read.
    pure function tics(values) result(text)
        real(dp), intent(in) :: values(:)
        character(len=:), allocatable :: text
        integer, parameter :: most = 16
        integer :: i

        text = ''
        do i = 1, size(values), 1 + (size(values) - 1) / most
            if (i > 1) text = text // ', '
            text = text // 'sprintf("%g", ' // short_text(values(i)) // ') ' // whole_text(i - 1)
        end do
    end function tics

end module run_pictures
