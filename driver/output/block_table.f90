!> What differs from block to block of a chain, as a table: BASE_blocks.csv.
module block_table
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use chain_settings, only : load_factors
    use friction_mod, only : constant_table, friction_constants, friction_law_of
    use number_text, only : full_row, whole_text
    use run_settings, only : settings
    use text_file, only : output_file
    implicit none
    private

    public :: block_columns, column_label, write_blocks

    character(len=*), parameter :: load_name = 'load_factor'

contains

    !> Columns of the table but for the number of the block: 0 stands for the normal traction over
    !> that of the programme, others are places in `props`. None, if all blocks are alike.
    pure function block_columns(run) result(columns)
        type(settings), intent(in) :: run
        integer, allocatable :: columns(:)
        integer :: place

        columns = [integer ::]
        if (run%chain%loads_differ()) columns = [0]
        if (.not. allocated(run%chain%constants)) return
        associate (c => run%chain%constants)
            do place = 1, size(c, 2)
                if (any(abs(c(:, place) - c(1, place)) > 0.0_dp)) columns = [columns, place]
            end do
        end associate
    end function block_columns

    !> Name and unit of a column, for pictures.
    pure function column_label(run, column) result(label)
        type(settings), intent(in) :: run
        integer, intent(in) :: column   !! of `block_columns`
        character(len=:), allocatable :: label
        type(constant_table) :: table

        label = 'load factor'
        if (column == 0) return
        table = friction_constants(friction_law_of(run%props))
        label = trim(table%of(column)%name)
        if (table%of(column)%unit /= '-') label = label // ' [' // trim(run%units%named( &
            table%of(column)%unit)) // ']'
    end function column_label

    !> Writes the table, if there is something to tell.
    subroutine write_blocks(base, run, written)
        character(len=*), intent(in) :: base   !! of the file's name, with the directory
        type(settings), intent(in) :: run
        logical, intent(out) :: written        !! or there is nothing to write
        type(output_file) :: file
        type(constant_table) :: table
        character(len=:), allocatable :: header
        integer, allocatable :: columns(:)
        real(dp), allocatable :: values(:, :)
        integer :: i, k

        written = .true.
        allocate (columns, source=block_columns(run))
        if (size(columns) == 0) return
        table = friction_constants(friction_law_of(run%props))
        allocate (values(run%chain%n_blocks, size(columns)))
        header = 'block'
        do k = 1, size(columns)
            if (columns(k) == 0) then
                header = header // ',' // load_name
                values(:, k) = load_factors(run%chain)
            else
                header = header // ',' // trim(table%of(columns(k))%name)
                values(:, k) = run%chain%constants(:, columns(k))
            end if
        end do
        call file%create(base // '_blocks.csv')
        call file%write_line(header)
        do i = 1, size(values, 1)
            call file%write_line(whole_text(i) // ',' // full_row(values(i, :)))
        end do
        call file%finish()
        written = .not. file%failed
    end subroutine write_blocks

end module block_table
